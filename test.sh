#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and runs every test but the slow ones. Arguments go to ctest: ./test.sh -L unit
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/tools/setup.sh"

install_missing "$root/tools/packages-build.txt" "$root/tools/packages-test.txt"
configure -DBUILD_TESTING=ON "-DORRERY_WERROR=${ORRERY_WERROR:-OFF}"
build all

cd "$root/build"
if [ $# -eq 0 ]; then set -- -LE slow; fi
ctest --no-tests=error --output-on-failure --parallel "$(nproc)" "$@" | { grep -vE '^ *[0-9]+/[0-9]+ Test +#.* Passed|^ +Start +[0-9]+' || true; }
