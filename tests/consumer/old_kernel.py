# SPDX-License-Identifier: Apache-2.0
"""Runs a program as on an older kernel: later system calls fail with ENOSYS.

    old_kernel.py LAST_CALL PROGRAM ARGUMENT...      LAST_CALL: the number of the last system call, on x86-64
"""

import ctypes
import errno
import os
import struct
import sys

PR_SET_SECCOMP, PR_SET_NO_NEW_PRIVS, SECCOMP_MODE_FILTER = 22, 38, 2
LOAD, JUMP_GREATER, RETURN = 0x20, 0x25, 0x06  # of classic BPF
RET_ERRNO, RET_ALLOW = 0x00050000, 0x7FFF0000

last_call = int(sys.argv[1])
statements = [(LOAD, 0, 0, 0), (JUMP_GREATER, 0, 1, last_call), (RETURN, 0, 0, RET_ERRNO | errno.ENOSYS), (RETURN, 0, 0, RET_ALLOW)]
code = b"".join(struct.pack("HBBI", *statement) for statement in statements)
text = ctypes.create_string_buffer(code, len(code))
program = ctypes.create_string_buffer(struct.pack("HxxxxxxP", len(statements), ctypes.addressof(text)))
libc = ctypes.CDLL(None, use_errno=True)
for words in ((PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), (PR_SET_SECCOMP, SECCOMP_MODE_FILTER, program, 0, 0)):
    if libc.prctl(*words) != 0:
        raise OSError(ctypes.get_errno(), "prctl")
os.execv(sys.argv[2], sys.argv[2:])
