#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the archive that runs on any Linux with an x86-64 processor, without installation: the program with all its
# libraries, their loader, a font, the manual, completions, examples, licences and SBOM.
#
#   tools/portable.sh [FOLDER]    default: build/portable; the file is orrery-VERSION-linux-x86_64.tar.xz
#
# The archive of a commit is the same in every build on the same system (tools/reproducible.sh).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/tools/setup.sh"
umask 022
folder=$(realpath -m -- "${1:-$root/build/portable}")

use_commit_date
install_missing "$root/tools/packages-build.txt" "$root/tools/packages-portable.txt"
# The build of test.sh serves as well.
if [ ! -f "$root/build/.configured-with" ]; then configure -DBUILD_TESTING=OFF; fi
reconfigure -DORRERY_STUBS=ON -DORRERY_ISAS=all
build 9 orrery
build 1 orrery_static
archive=$folder/orrery-$(release_version)-linux-x86_64.tar.xz
"$root/tools/bundle.py" archive "$root/build" "$archive"
say "$archive: $(stat -c %s "$archive" | numfmt --to=si)B"
