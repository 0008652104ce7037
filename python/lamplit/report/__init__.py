# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What a render leaves behind: pictures for a display, exact values, numbers and comparisons."""
