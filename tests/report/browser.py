#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens a study's report in a browser, in dark and light mode, narrow and wide: tests/report/browser.py ORRERY WORK_FOLDER

Exit status 77 if Chromium or its driver is not installed.
"""
import json
import pathlib
import shutil
import subprocess
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(here.parent / "browser"))
from webdriver import Browser, exit_if_missing

exit_if_missing()
orrery, work = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
shutil.rmtree(work, ignore_errors=True)
work.mkdir(parents=True)
report = work / "report.html"
# A small budget shortens the report. On a slow machine it may be too small for any measurement, which is an error.
for budget in ("6s", "60s", "600s"):
    study = subprocess.run([orrery, "study", here / "../../scenes/trade/glass.toml", "--budget", budget, "--noise", "0.05",
                            "-q", "-o", report], stdout=subprocess.DEVNULL, check=False)
    if study.returncode == 0:
        break
study.check_returncode()

press = (here / "press.js").read_text(encoding="utf-8")
for dark in (True, False):
    for width in (500, 1400):
        browser = Browser(width=width, dark=dark)
        try:
            browser.open(report.as_uri())
            browser.run(press)
            # Not a budget of time: images are decoded when the machine gets to it.
            result = json.loads(browser.wait("return document.documentElement.dataset.result"))
        finally:
            browser.close()
        print(f"{'dark' if dark else 'light'}, {width} px wide: {result}")
        wrong = [name for name, value in result.items() if value != (dark if name == "dark" else True)]
        if wrong or len(result) < 10:
            sys.exit(f"wrong or missing: {wrong}")
