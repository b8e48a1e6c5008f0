#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Opens a study's report in a browser, in dark and light mode, narrow and wide: tests/report/browser.sh ORRERY WORK_FOLDER
# Exit status 77 if Chromium is not installed.
set -eu
orrery=$1 work=$2
here=$(cd "$(dirname "$0")" && pwd)
if ! command -v chromium >/dev/null; then
  echo "chromium is not installed; apt-get install chromium"
  exit 77
fi
rm -rf "$work"
mkdir -p "$work/profile"
# A small budget shortens the report. On a slow machine it may be too small for any measurement, which is an error.
for budget in 6s 60s 600s; do
  if "$orrery" study "$here/../../scenes/trade/glass.toml" --budget $budget --noise 0.05 -q -o "$work/report.html" \
    >"$work/report.txt"; then break; fi
done
# Appends the script that presses the page's buttons and stores the results in the page.
{ sed 's|</body>||; s|</html>||' "$work/report.html" && printf '<script>' && cat "$here/press.js" &&
  printf '</script></body></html>\n'; } >"$work/pressed.html"
# Preferred colour scheme: 0 is dark, 1 is light.
for look in 0 1; do
  for width in 500 1400; do
    chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$work/profile" \
      --blink-settings=preferredColorScheme=$look --window-size=$width,900 --virtual-time-budget=4000 \
      --dump-dom "file://$work/pressed.html" >"$work/dom-$look-$width.html" 2>"$work/log"
    sed -n 's/.*data-result="\([^"]*\)".*/\1/p' "$work/dom-$look-$width.html" | sed 's/&quot;/"/g' >"$work/result"
    echo "scheme $look, $width px wide: $(cat "$work/result")"
    for expected in '"ready":true' '"fits":true' '"sorts":true' '"sortsBack":true' '"chooses":true' '"slides":true' \
      '"pictures":true' '"front":true' '"slopes":true' "\"dark\":$([ $look = 0 ] && echo true || echo false)"; do
      if ! grep -qF "$expected" "$work/result"; then
        echo "missing $expected; the last lines of the browser's log:"
        tail -n 5 "$work/log"
        exit 1
      fi
    done
  done
done
