# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Cases that hold Lamplit against closed forms and against another renderer."""
