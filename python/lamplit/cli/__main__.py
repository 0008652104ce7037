# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``python -m lamplit.cli`` is ``lamplit``."""

from __future__ import annotations

import sys

from lamplit.cli import main

sys.exit(main())
