# SPDX-License-Identifier: Apache-2.0
# Changes commands of documents before tools/documents.sh runs them.

# tools/minimal-root.sh runs these two in a bare system.
s/^\.\/run\.sh( +#.*)?$/not run: tools\/minimal-root.sh runs .\/run.sh/
s/^\.\/test\.sh.*/not run: tools\/minimal-root.sh runs .\/test.sh/
s/^\.\/run\.sh --install.*/not run: installs/
s/^(python3 -m venv|venv\/bin\/(pip|python)) .*/not run: installs; the tests wheel and pip.sh do/
s/^(docker|apptainer) .*/not run: the test portable_container runs the image/
s/^\.\/run\.sh /orrery /

# Builds.
s/^(time )?(cmake|ctest|ninja) .*/not run: builds/
s/^tools\/(packages|portable|wheel|reproducible|minimal-root|mutants|steady|documents|site)\.sh.*/not run: builds, or another check/
s/^build\/spiral .*/not run: the test consumer runs it/
s/^build-ci\/.*/not run: needs a build of benchmarks/

# Benchmarks: their programs have tests; those that compare stored results are run.
/^bench\/(compare|plot)\.py [^A-Z]/b
s/^(build\/)?bench\/.*/not run: benchmark/
s/^perf .*/not run: benchmark/

# Other machines, other programs, and names to be filled in.
s/^ssh .*/not run: another machine/
s/^(apt|apt-get) .*/not run: changes the system/
s/.*[ .\/](NAME|FILE|DATA|OLD\.json|RESULT\.json|N)( .*|$)/not run: has a name to be filled in/

# The files of an installation.
s/\/usr\/share\/orrery\//src\/display\/config\//

# An example whose program takes the width of the image.
s/^\.\/attractor\.py$/.\/attractor.py 240/

# Fewer points.
s/7\.1e7/7.1e4/
