"""The text and tables of docs/background/voxels.md."""

from __future__ import annotations

from typing import Any

from benchmarks.voxel_raster import OURS, TRIMESH

_USE = """The utility must be set to the mode of the stack. `show` checks every slice against the rules, counts the droplets and draws two sections. The
printer's profile must have a `[voxel_print]` table; `j735` has one, the Objet260 takes no stacks.

## What is in the folder

`<name>_0.png`, `<name>_1.png` ... from the tray up, no gaps, all of one size, 32-bit RGBA, as many colours as there are resins; and
`stack.json`, which states the colour of each resin (the operator assigns them in the utility), the raster, the droplets of each resin,
the requested and the realised fraction of each body, the seed, the assumptions, and the SHA-256 of every slice. Bodies that are printed
with the membrane are included; a plug or ring is not.

- Pixels are 25.4/600 mm wide and 25.4/300 mm deep. The dots per inch are the integers nearest to 25400 over the profile's `resolution`,
  so 42.33 um is 600.
- Row 0 is at the greatest y, seen from above. The vendor does not state this; compare a slice with the part before a long print.
- A voxel belongs to the body that contains its centre, computed on the exact arcs and lines. Faces are half-open: where two bodies meet,
  every voxel belongs to one of them.
- Background is opaque black, as in the utility's example files. The colour of a resin follows its position among the printer's resins.
- Fewer than 30 slices, more colours than the mode takes, or a stack larger than the printer are refused before anything is written.
- A catalogue material such as FLX9960 has no published mix. It is dithered at the fraction that its mixing curve assumes
  ([mixing.md](mixing.md)), and `stack.json` states this.

## The skin

A voxel of a mixed body with one of its six neighbours outside is skin and stays the soft resin, also towards the connector. The stiff
droplets removed from the skin go to the voxels just beneath, within 0.12 to 0.4 mm, one for one: the fraction over the body, and through
the wall anywhere, is the requested one. A cube just beneath a skin holds more than requested, the skin next to it less. A wall too
thin or too stiff for this has too small a fraction; a warning and `stack.json` report this.
"""


def page(found: dict[str, Any]) -> str:
    """The page from the measured numbers."""
    return "\n".join([*_answer(found), _USE, *_dither(found), *_raster(found), *_time(found), *_limits()])


def _answer(found: dict[str, Any]) -> list[str]:
    worst = max(row["bodies"]["membrane"]["worst_cube"] for row in found["stacks"])
    fast = found["stacks"][0]
    return [
        "# Voxel stacks",
        "",
        "How is a graded membrane printed, for which no printer has a resin at every point? GrabCAD Voxel Print takes one image a layer, in which every pixel is one "
        "droplet of one base resin. `--voxels` writes this stack in addition to the build: the graded dome takes "
        f"{fast['seconds']:.0f} s in the mode {fast['mode']}, and the fraction in any cube of 1 mm is off by at most {worst:.2%}.",
        "",
        "![The middle of the graded dome, upright above and across below, to one scale](voxels.png)",
        "",
        "*The middle of the graded dome's stack: upright section (above) and one layer (below), to one scale.*",
        "",
        "```sh",
        'pneutouch build graded-dome --voxels --voxel-mode "High Mix"    # outputs/graded-dome and outputs/graded-dome-voxels',
        "pneutouch show outputs/graded-dome-voxels --out section.png",
        "pneutouch check graded-dome --voxels",
        "```",
        "",
        "`--voxel-mode` is the print mode whose layers are written; the default is the finest mode of the design.",
    ]


def _dither(found: dict[str, Any]) -> list[str]:
    return [
        "## The dither",
        "",
        *verdict(found["dithers"]),
        "",
        "![Layers, upright sections and spectra of the three dithers](dither.svg)",
        "",
        "*One layer, an upright section and the spectrum of each dither at one fraction.*",
        "",
        "One uniform fraction on a block of 2.6 x 5.4 x 5.4 mm. *Cube* is the greatest error of the fraction in any cube of 1 mm (10,656 voxels). *Clumps* is the mean "
        "power of waves longer than 0.4 mm over that of white noise, *peak* the greatest of one such wave. Error diffusion passes half of a voxel's error to the next row "
        "and half to the next layer, with rows turned from layer to layer and a randomised threshold; it runs 96 layers before the block.",
        "",
        *dithers(found["dithers"]),
        "",
    ]


def _raster(found: dict[str, Any]) -> list[str]:
    return [
        "## Raster: speed against accuracy",
        "",
        "![Error of volume and of the surface over time](voxels.svg)",
        "",
        "*Error of the volume, and distance of the boundary between voxels from the exact surface, over processor time.*",
        "",
        "Only the membrane. The other programs slice the same mesh (chord tolerance 5 um) with manifold3d and fill the polygons with Pillow or matplotlib; trimesh's "
        "voxels are cubes. Pillow fills every pixel that an edge touches, trimesh every cube that the surface touches. The raster itself bounds the surface: half a "
        "voxel's diagonal is 49 um at 27 um layers.",
        "",
        *rasters(found["rasters"]),
        "",
    ]


def _time(found: dict[str, Any]) -> list[str]:
    return [
        "## Time and memory",
        "",
        "The graded dome and its connector, one core. Peak memory is of the whole process.",
        "",
        *stacks(found["stacks"]),
        "",
    ]


def _limits() -> list[str]:
    return [
        "## Limits",
        "",
        "No stack was printed in this project. The orientation of the images is assumed, and so is the fraction of a catalogue material. `make voxel-page` writes this page.",
        "",
    ]


def stacks(rows: list[dict[str, Any]]) -> list[str]:
    lines = [
        "| mode | slices | time s | peak MB | files MB | reading s | volume error | fraction requested, realised | worst cube |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        wide, tall = row["pixels"]
        body = row["bodies"]["membrane"]
        off = ", ".join(
            f"{name} {b['volume_mm3'] / b['exact_volume_mm3'] - 1:+.2%}" for name, b in row["bodies"].items()
        )
        lines.append(
            f"| {row['mode']}, {row['layer_um']:g} um | {row['layers']} of {wide} x {tall} | {row['seconds']:.1f} | {row['peak_MB']:.0f} | "
            f"{row['MB']:.0f} | {row['reading_seconds']:.1f} | {off} | {body['fraction_requested']:.3%}, {body['fraction_realised']:.3%} | "
            f"{body['worst_cube']:.2%} |"
        )
    return lines


def dithers(rows: list[dict[str, Any]]) -> list[str]:
    lines = [
        "| dither | fraction | whole block | cube | clumps | peak | s a million |",
        "|---|---|---|---|---|---|---|",
    ]
    return lines + [
        f"| {row['method']} | {row['fraction']:g} | {row['whole']:.3%} | {row['cube']:.2%} | {row['clumps']:.3f} | {row['peak']:.2f} | "
        f"{row['seconds']:.3f} |"
        for row in rows
    ]


def verdict(rows: list[dict[str, Any]]) -> list[str]:
    """What the numbers show."""

    def of(method: str, key: str) -> list[float]:
        return [row[key] for row in rows if row["method"] == method]

    blue, diffused = "blue noise", "error diffusion"
    middling = max(row["peak"] for row in rows if row["method"] == blue and 0.1 <= row["fraction"] <= 0.9)
    slower = min(of(diffused, "seconds")) / max(of(blue, "seconds"))
    return [
        f"Stacks are made with blue noise: the fraction in any cube is off by at most {max(of(blue, 'cube')):.2%}, against "
        f"{max(of(diffused, 'cube')):.2%} by error diffusion, which is {slower:.0f} times slower here because each row depends on the "
        "one before. Each voxel of blue noise is computed independently, so it gets the same droplet whatever surrounds "
        "it, and a droplet stays as the fraction grows. The block of 1.3 mm is shifted cyclically at every repetition: repeated "
        "unchanged, it would give a pattern of that size, with more than a thousand times the power of white noise in one "
        f"wave. Single waves longer than 0.4 mm have at most {middling:.1f} times the power of white noise from 0.1 to 0.9 and "
        f"{max(of(blue, 'peak')):.0f} times where droplets are rare, against {max(of(diffused, 'peak')):.0f} by error diffusion "
        "and the 6 to 8 that white noise itself reaches by chance. The seams reduce the uniformity a little."
    ]


def rasters(rows: list[dict[str, Any]]) -> list[str]:
    lines = ["| method | raster | time s | volume | surface mean um | greatest um |", "|---|---|---|---|---|---|"]
    for row in rows:
        cube = row["method"] == TRIMESH
        step = f"cubes of {row['layer_um']:g} um" if cube else f"{row['layer_um']:g} um layers, x {row['coarser']:g}"
        name = f"**{row['method']}**" if row["method"] == OURS else row["method"]
        lines.append(
            f"| {name} | {step} | {row['seconds']:.3f} | {row['volume']:+.2%} | {1e3 * row['mean']:.0f} | {1e3 * row['most']:.0f} |"
        )
    return lines
