#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Stops a render that would not end: the preview shows that it has begun, and SIGINT ends it with status 130. A program
# that has no handler ignores SIGINT, because it is in the background, and is killed.
#
#   stop.sh PROGRAM IMAGE [TENTHS]      TENTHS of a second that it has for stopping; default: 3000
set -u
"$1" "$2" 1000000000 > /dev/null &
while ! [ -e "$2" ]; do
  kill -0 $! || exit 1 # it failed
  sleep 0.1
done
kill -INT $!
left=${3:-3000}
while kill -0 $! 2> /dev/null && [ "$left" -gt 0 ]; do
  left=$((left - 1))
  sleep 0.1
done
if [ "$left" -eq 0 ]; then kill -KILL $!; fi
wait $!
[ $? = 130 ]
