# SPDX-License-Identifier: MIT OR Apache-2.0
"""Superdeform for Blender: a panel in the 3D view's sidebar, and an operator with redo."""

from . import panel

register, unregister = panel.register, panel.unregister
