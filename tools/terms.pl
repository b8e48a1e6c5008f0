#!/usr/bin/env perl
# SPDX-License-Identifier: Apache-2.0
# Reports the words and phrases of tools/terms.txt in tracked files as FILE:LINE. Exit status 1 if there are any.
#
#   tools/terms.pl [FILE...]   default: all tracked text files except the list itself
use strict;
use warnings;
use FindBin;

chdir "$FindBin::Bin/.." or die "terms.pl: cannot enter $FindBin::Bin/..: $!\n";
my $list = 'tools/terms.txt';
my %ignored = map { $_ => 1 } $list, 'LICENSE';

# A phrase may continue on the next line of a comment, after its indentation and comment mark.
my $gap = qr{(?:[ \t]+|[ \t]*\n[ \t]*(?:///?|\#|\*|--)?[ \t]*)};
my @terms;
open my $in, '<', $list or die "terms.pl: cannot open $list: $!\n";
while (<$in>) {
  next if /^\s*(?:#|$)/;
  /^(.+?)  =>  (.+)$/ or die "$list:$.: expected: REGEX  =>  REPLACEMENT\n";
  my ($pattern, $replacement) = ($1, $2);
  $pattern =~ s/(?<!\[) /$gap/g;
  push @terms, [qr/\b(?:$pattern)\b/i, $replacement];
}
close $in;

my @files = @ARGV ? @ARGV : split /\0/, `git ls-files -z`;
my $found = 0;
for my $file (@files) {
  next if $ignored{$file} || -l $file || !-f $file || -B $file;
  open my $in, '<', $file or die "terms.pl: cannot open $file: $!\n";
  my $text = do { local $/; <$in> };
  close $in;
  next unless defined $text;
  for my $term (@terms) {
    my ($regex, $replacement) = @$term;
    while ($text =~ /$regex/g) {
      my $line = 1 + (substr($text, 0, $-[0]) =~ tr/\n//);
      (my $phrase = $&) =~ s/\s*\n\s*\S*\s*/ /g;
      print STDERR "$file:$line: \"$phrase\"; write: $replacement\n";
      ++$found;
    }
  }
}
exit($found > 0);
