# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What `docs/make.py` puts together: tables and pictures from the program itself."""
