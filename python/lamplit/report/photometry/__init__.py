# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What a lamp engineer sees of a measurement: tables, plots, files, and one page with all of it."""
