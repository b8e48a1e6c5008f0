# SPDX-License-Identifier: Apache-2.0
"""What a processor lacks is known before the extension module is loaded."""

import unittest

from orrery import _processor


class Processor(unittest.TestCase):
    def test_flags(self):
        self.assertEqual(_processor.missing("model name: x\nflags\t\t: fpu sse4_2 aes pclmulqdq avx\n"), [])
        self.assertEqual(_processor.missing("flags\t\t: fpu sse4_1 aes\n"), ["pclmulqdq", "sse4_2"])
        self.assertEqual(_processor.missing("Features: asimd aes\n"), [])


unittest.main()
