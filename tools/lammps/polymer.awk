# SPDX-License-Identifier: Apache-2.0
# Random walks in a periodic box, as LAMMPS data: the beginning of polymer.in.
BEGIN {
  srand(7)
  chains = 120
  beads = 50
  side = (chains * beads / 0.85) ^ (1 / 3)
  print "random walks\n\n" chains * beads " atoms\n" chains * (beads - 1) " bonds\n1 atom types\n1 bond types\n"
  print 0, side, "xlo xhi\n" 0, side, "ylo yhi\n" 0, side, "zlo zhi\n\nMasses\n\n1 1\n\nAtoms # bond\n"
  for (chain = 1; chain <= chains; ++chain) {
    x = side * rand()
    y = side * rand()
    z = side * rand()
    for (i = 1; i <= beads; ++i) {
      print ++id, chain, 1, x, y, z
      up = 2 * rand() - 1
      angle = 6.2831853 * rand()
      across = 0.97 * sqrt(1 - up * up)
      x += across * cos(angle)
      y += across * sin(angle)
      z += 0.97 * up
    }
  }
  print "\nBonds\n"
  for (chain = 0; chain < chains; ++chain)
    for (i = 1; i < beads; ++i) print ++bond, 1, chain * beads + i, chain * beads + i + 1
}
