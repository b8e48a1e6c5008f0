#!/usr/bin/env perl
# SPDX-License-Identifier: Apache-2.0
# Reports Markdown whose lines were joined by mistake, as FILE:LINE: the separator row of a table within a line, text
# after the language of a code fence, a fence that is not closed, and a last line that does not end. Exit status 1 if
# there is any.
#
#   tools/markdown.pl [FILE...]   default: all tracked Markdown files
use strict;
use warnings;
use FindBin;

@ARGV or chdir "$FindBin::Bin/.." or die "markdown.pl: cannot enter $FindBin::Bin/..: $!\n";
my @files = @ARGV ? @ARGV : split /\0/, `git ls-files -z '*.md'`;
my $found = 0;

sub report {
  my ($file, $line, $message) = @_;
  print STDERR "$file:$line: $message\n";
  ++$found;
}

for my $file (@files) {
  open my $in, '<', $file or die "markdown.pl: cannot open $file: $!\n";
  my ($fence, $last) = (0, "\n");  # line of the open fence
  while (<$in>) {
    $last = $_;
    if (/^\s*```(.*)$/) {
      my $info = $1;
      report($file, $., "text after the language of a code block") if $info =~ /[^\w+-]/ || ($fence && $info ne '');
      $fence = $fence ? 0 : $.;
    } elsif (!$fence && /\|\s*:?---/ && !/^\s*\|[-|: ]+$/) {
      report($file, $., "the separator row of a table is not a separate line");
    }
  }
  report($file, $fence, "the code block is not closed") if $fence;
  report($file, $., "the last line does not end in a newline") if $last !~ /\n\z/;
  close $in;
}
exit($found > 0);
