#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the web site of the documents, with the references of the Python package and the C++ library, and checks its links
# and images. It needs the packages of tools/packages-site.txt, and nothing that has to be built.
#
#   tools/site.sh [FOLDER]      default: build/site
#
# `python3 -m http.server -d build/site` shows it, with search; without a server, build/site/index.html is without search.
#
# Exit status: 0; 1 if the site has a fault; 77 without mkdocs.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
site=${1:-$root/build/site}
if ! command -v mkdocs >/dev/null || [ ! -d /usr/share/mkdocs/themes/material ]; then
  printf 'Not built: the packages in tools/packages-site.txt are missing.\n'
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$root/tools/site/pages.py" "$work"
mkdocs build --quiet --strict --clean -f "$work/mkdocs.yml" -d "$(realpath -m "$site")"
/usr/bin/python3 "$root/tools/site/check.py" "$site"
