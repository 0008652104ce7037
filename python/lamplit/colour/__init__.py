# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From spectra to XYZ, from XYZ to a display: colorimetry, adaptation, gamut, difference."""
