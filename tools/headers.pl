#!/usr/bin/env perl
# SPDX-License-Identifier: Apache-2.0
# Counts the project headers that each header under src/ includes, directly or through others. Prints the share of
# headers that include at most six, and the others, worst first. Exit status 1 if the share is below the
# goal.
#
#   tools/headers.pl           prints the share and all headers above the limit
#   tools/headers.pl --check   prints nothing unless the share is below the goal
use strict;
use warnings;
use File::Find;
use FindBin;

use constant LIMIT => 6;      # included project headers
use constant GOAL => 0.9;     # of the headers

my $check = @ARGV && $ARGV[0] eq '--check';
chdir "$FindBin::Bin/../src" or die "headers.pl: cannot enter $FindBin::Bin/../src: $!\n";

my %includes;  # by header
find({no_chdir => 1, wanted => sub {
  return unless /\.h$/;
  (my $header = $_) =~ s{^\./}{};
  open my $in, '<', $_ or die "headers.pl: cannot open $_: $!\n";
  $includes{$header} = [map { /^\s*#\s*include\s+"([^"]+)"/ ? $1 : () } <$in>];
}}, '.');

my %included;
for my $header (keys %includes) {
  my (%seen, @next);
  @next = ($header);
  while (defined(my $at = shift @next)) {
    push @next, grep { $includes{$_} && $_ ne $header && !$seen{$_}++ } @{$includes{$at}};
  }
  $included{$header} = keys %seen;
}

my @above = sort { $included{$b} <=> $included{$a} || $a cmp $b } grep { $included{$_} > LIMIT } keys %included;
my $share = 1 - @above / keys %included;
my $met = $share >= GOAL;
if (!$check || !$met) {
  printf "%.1f %% of %d headers include at most %d project headers, directly or through others; the goal is %.0f %%\n", 100 * $share,
         scalar keys %included, LIMIT, 100 * GOAL;
  printf "%4d  %s\n", $included{$_}, $_ for @above;
}
exit($met ? 0 : 1);
