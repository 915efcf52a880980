"""Registers Oriel: NERFBASELINES_REGISTER=.../oriel_spec.py, see README.md."""
import os
import sys

from nerfbaselines import register

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
register({
    "id": "oriel",
    "method_class": "oriel:Oriel",
    "backends_order": ["python"],
    "metadata": {
        "name": "Oriel",
        "description": "Point-cloud image-based rendering: stereo with the given cameras, then "
                       "every picture is blended from the photographs. Nothing is trained.",
        "licenses": [{"name": "MIT"}],
    },
})
