# SPDX-License-Identifier: Apache-2.0
"""Checks that the processor can execute the extension module, which would otherwise end the process."""


def missing(cpuinfo):
    """Returns what a processor lacks, from the text of /proc/cpuinfo; other systems than x86-64 have no such flags."""
    for line in cpuinfo.splitlines():
        name, _, flags = line.partition(":")
        if name.strip() == "flags":
            return sorted({"sse4_2", "aes", "pclmulqdq"} - set(flags.split()))
    return []


with open("/proc/cpuinfo", encoding="ascii", errors="replace") as _file:
    _missing = missing(_file.read(1 << 16))
if _missing:
    raise ImportError(f"this processor lacks {', '.join(_missing)}, which orrery needs")
