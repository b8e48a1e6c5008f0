#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Stops a render that would not end: the preview shows that it has begun, and SIGINT ends it with status 130.
#
#   stop.sh PROGRAM IMAGE
set -u
"$1" "$2" 1000000000 > /dev/null &
while ! [ -e "$2" ]; do
  kill -0 $! || exit 1 # it failed
  sleep 0.1
done
kill -INT $!
wait $!
[ $? = 130 ]
