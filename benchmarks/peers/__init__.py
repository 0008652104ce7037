# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Other renderers, each in a process of its own."""
