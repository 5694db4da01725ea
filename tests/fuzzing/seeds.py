"""What a target begins with: the shipped files, and small ones of the kinds that none is shipped of."""

from __future__ import annotations

import json
import tempfile
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.formats import format_of, versioned
from pneutouch.results.record import plain as data
from tests.fuzzing.files import library
from tests.fuzzing.parts import parts
from tests.fuzzing.place import ROOT

if TYPE_CHECKING:
    from pneutouch.evaluation import Evaluation

FOLDERS = {
    "design": "designs/*.toml",
    "specimen": "designs/specimens/*.toml",
    "material": "printprofiles/materials/*.toml",
    "printer": "printprofiles/*.toml",
    "gauge": "printprofiles/gauges/*.toml",
    "mixing": "printprofiles/mixing/*.toml",
    "port": "generator/pneutouch/parts/ports/*.toml",
    "seat": "generator/pneutouch/parts/seats/*.toml",
    "mount": "generator/pneutouch/parts/mounts/*.toml",
    "target": "docs/examples/fingertip.toml",
    "sweep": "docs/examples/wall-and-resin.toml",
    "tray": "docs/examples/seven-resins.toml",
    "campaign": "docs/examples/campaign.toml",
}

POINTS = b"file,indentation_mm,contact_force_N,pressure_rise_kPa\na.csv,0,0,0\na.csv,1,0.5,1.2\n"
MEASUREMENT = {
    "format": format_of("figures"),
    "design": "paper-dome",
    "simulated": False,
    "runs": [{"file": "a.csv", "kind": "steps", "sensor": "A"}],
    "groups": [
        {
            "resin": "TangoPlus",
            "age": "0 days",
            "driving_pressure_kPa": 0.0,
            "files": ["a.csv"],
            "figures": {
                "sensitivity_kPa_per_N": {
                    "value": 2.0,
                    "low": 1.9,
                    "high": 2.1,
                    "predicted": {"value": 2.2, "low": 2.0, "high": 2.4},
                }
            },
        }
    ],
}

TASKS = '[[task]]\nname = "grip"\nsensitivity_kPa_per_N = 1.9\n[[task]]\nforce_range_N = 15\n[[task]]\nstiffness_N_per_mm = 2\n'
TASKS_CSV = "name,sensitivity_kPa_per_N,stiffness_N_per_mm,force_range_N\ngrip,1.9,,\ntouch,,2,\nhold,,,15\n"
FIGURES = {
    "format": format_of("figures"),
    "design": "paper-dome",
    "injections": [{"unit": "kPa/min", "value": 0.1, "figure": "leak, 12 kPa"}],
}
QUESTIONS = (
    {"base": "paper-dome", "values": {}},
    {"base": "agilus-dome", "values": {"membrane.wall_thickness_mm": "1.4", "pneumatics.gauge": None}},
    {"base": "paper-dome", "values": {"pneumatics.driving_pressures_kPa": "0, 5", "membrane.material": "FLX9950"}},
    {"base": "paper-dome", "values": {"contact.object": "ball", "contact.ball_radius_mm": "6"}},
)
SEARCHES = (
    {"base": "", "values": {"target.sensitivity_kPa_per_N": "1.9", "target.driving_pressure_kPa": "12"}},
    {
        "base": "",
        "values": {
            "target.sensitivity_kPa_per_N": "2",
            "given.materials": '["TangoPlus"]',
            "setting.base": "paper-dome",
        },
    },
)
MEASURED = {
    "columns": "force=Load:N",
    "format": {"delimiter": ";", "decimal": ",", "skip_rows": "2"},
    "fit": ["modulus"],
    "hold_out_kPa": [12, 22.5],
    "paths": ["a/b.csv"],
    "runs": [{"file": "a.csv", "kind": "steps", "sensor": "A", "resin": "TangoPlus", "driving_pressure_kPa": 0}],
}
HEADS = (
    "POST /api/open\nhost: 127.0.0.1:8123\norigin: http://127.0.0.1:8123\npneutouch-key: the-token\n",
    "POST /api/quick\nhost: localhost:8123\norigin: http://localhost:8123\npneutouch-key: the-token\n"
    "content-type: application/json\ncontent-length: 12\n",
)
MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" xmlns:p="{space}">
<metadata name="Title">a</metadata><metadata name="p:recipe" type="xs:base64Binary">{recipe}</metadata>
<metadata name="p:input-hash" type="xs:string">{hash}</metadata>
<resources><basematerials id="1"><base name="TangoPlus" displaycolor="#204060FF"/></basematerials>
<object id="2" type="model" pid="1" pindex="0"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
<vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>
<triangle v1="0" v2="1" v3="3"/><triangle v1="1" v2="2" v3="3"/><triangle v1="2" v2="0" v3="3"/></triangles></mesh></object>
</resources><build><item objectid="2"/></build></model>
"""
TYPES = """<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"""
RELATIONS = """<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="r0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"""


def seeds(target: str) -> list[bytes]:
    """The first inputs of a target."""
    if target in FOLDERS:
        return [path.read_bytes() for path in sorted(ROOT.glob(FOLDERS[target]))]
    texts = {"tasks": [TASKS], "tasks-csv": [TASKS_CSV], "head": list(HEADS), "calibration": [_calibration()]}
    documents = {
        "leak": [FIGURES],
        "question": QUESTIONS,
        "search": SEARCHES,
        "measured": [MEASURED],
        "exported": [
            {"format": format_of("exported-design"), "version": "1.0", **question} for question in QUESTIONS[:2]
        ],
        "figures": [MEASUREMENT],
        "journal": [{"sweep": "ab", "records": [{"point": 0, "states": [{"status": "ok"}], "values": {"a": 1.0}}]}],
    }
    if target in documents:
        return [json.dumps(each, indent=1).encode() for each in documents[target]]
    if target in texts:
        return [text.encode() for text in texts[target]]
    return {
        "coupons": _coupons,
        "run-csv": _runs,
        "run-xlsx": lambda: [parts(_written("excel"))],
        "run-parquet": lambda: [_written("parquet")],
        "run-tdms": lambda: [_written("tdms")],
        "prediction": lambda: [_prediction()],
        "recipe": lambda: [_recipe().encode()],
        "threemf": lambda: [_threemf()],
        "dataset": _datasets,
        "slice": lambda: [_slice()],
        "stack": lambda: [_stack()],
    }[target]()


def _calibration() -> str:
    from pneutouch.spec.toml_text import toml_text
    from tests.evaluation.calibrated import CONTENT

    return toml_text(CONTENT)


def _coupons() -> list[bytes]:
    from tests.stability.fuzz.cases import RESULTS

    return [RESULTS.encode()]


def _written(name: str) -> bytes:
    from tests.bench.rig import small
    from tests.tables import instruments

    time, position, force, pressure = small(rate=4.0, depths=(1.0,))
    with tempfile.TemporaryDirectory() as folder:
        path: Path = getattr(instruments, name)(Path(folder), time, position, force, pressure * 1e3)
        return path.read_bytes()


def _runs() -> list[bytes]:
    names = (
        "plain",
        "labview",
        "labview_without_times",
        "instron",
        "zwick",
        "mts",
        "mts_testsuite",
        "logger",
        "savetxt",
    )
    return [_written(name) for name in names]


@cache
def _evaluated() -> Evaluation:
    from pneutouch.evaluation.evaluate import evaluate

    return evaluate("paper-dome", {}, model="membrane", library=library())


@cache
def recipe() -> tuple[dict[str, Any], str, str]:
    """Inputs of the recipe of the paper's sensor, its version and its hash."""
    from pneutouch.output.files import input_hash
    from pneutouch.output.recipe import BuildRecipe

    known = BuildRecipe.of(_evaluated())
    return known.inputs(), known.version, input_hash(known.inputs(), known.version)


def _recipe() -> str:
    from pneutouch.output.recipe import BuildRecipe

    return BuildRecipe.of(_evaluated()).text()


def _prediction() -> bytes:
    from pneutouch.evaluation.result import predicted

    return json.dumps(versioned("prediction", data(predicted(_evaluated())))).encode()


def _threemf() -> bytes:
    from base64 import b64encode

    from pneutouch.export.threemf import NAMESPACE

    model = MODEL.format(space=NAMESPACE, recipe=b64encode(_recipe().encode()).decode(), hash=recipe()[2])
    named = {"[Content_Types].xml": TYPES, "_rels/.rels": RELATIONS, "3D/3dmodel.model": model}
    return "".join(f"=== {name}\n{text}\n" for name, text in named.items()).encode()


def _datasets() -> list[bytes]:
    import xarray

    from pneutouch.workflows.sweep.dataset import _CONTENT_HASH, _UNHASHED, seal

    content = xarray.Dataset(
        {
            "sensitivity_kPa_per_N": (("a", "b"), np.arange(6.0).reshape(2, 3), {"units": "kPa/N"}),
            "status": (("a",), np.array(["ok", ""], object), {"long_name": "status"}),
        },
        {"a": ("a", np.array([1, 2], np.int32)), "b": ("b", np.arange(3.0), {"units": "kPa"})},
        {"input_hash": "ab", "title": "a sweep"},
    )
    content.attrs["format"] = format_of("dataset")
    content.attrs[_CONTENT_HASH] = _UNHASHED.decode()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.nc"
        content.to_netcdf(path, engine="scipy", format="NETCDF3_64BIT")
        seal(path)
        return [path.read_bytes()]


def _slice() -> bytes:
    from pneutouch.export.voxels.png import encode, table

    return encode(np.array([[0, 1], [1, 0]], np.uint8), table([(0, 0, 0, 0), (1, 2, 3, 255)]), (600, 300))


def _stack() -> bytes:
    content = {
        "format": format_of("stack"),
        "layers": 30,
        "prefix": "a_",
        "sha256": "ab" * 32,
        "dpi": [600, 300],
        "pixels": [2, 2],
        "pixel_um": [42.3, 84.7],
        "background_rgba": [0, 0, 0, 0],
        "slices": ["ab" * 32] * 30,
        "resins": {"TangoPlus": {"rgba": [1, 2, 3, 255], "voxels": 4}},
        "bodies": {"membrane": {}},
        "layer_um": 27.0,
    }
    return json.dumps(content).encode()
