"""The text and tables of docs/background/voxels.md."""

from __future__ import annotations

from typing import Any

from benchmarks.voxel_raster import OURS, TRIMESH

_HEAD = """# Voxel stacks

`make voxel-page` writes this page and its pictures.

A graded membrane cannot be printed body by body, since no printer has a resin for every point of it. GrabCAD Voxel Print takes
a stack of images instead, one for each layer, in which every pixel is one droplet of one base resin. `--voxels` writes it in addition to the build:

```sh
pneutouch build graded-dome --voxels --voxel-mode "High Mix"    # outputs/graded-dome and outputs/graded-dome-voxels
pneutouch show outputs/graded-dome-voxels --out section.png
pneutouch check graded-dome --voxels
```

`--voxel-mode` is the print mode whose layers are written; the default is the finest mode of the design. The utility must be set
to the same mode. `show` checks every slice against the rules, counts the droplets and draws two sections. The printer's profile
must have a `[voxel_print]` table; `j735` has one, the Objet260 takes no stacks.

![The middle of the graded dome, upright above and across below, to one scale](voxels.png)

## What is in the folder

`<name>_0.png`, `<name>_1.png` ... from the tray up, no gaps, all of one size, 32-bit RGBA, as many colours as there are
resins, and `stack.json`. This file states the colour of each resin (the utility has no such table: the operator assigns them), the raster,
the droplets of each resin, the requested and the realised fraction of each body, the seed, the assumptions, and the SHA-256 of
every slice. Bodies that are printed with the membrane are included; a plug or ring is not.

- Pixels are 25.4/600 mm wide and 25.4/300 mm deep. The dots per inch are the integers nearest to 25400 over the profile's
  `resolution`, so 42.33 um is 600.
- Row 0 is at the greatest y, seen from above. The vendor does not state this; compare a slice with the part before a long print.
- A voxel belongs to the body that contains its centre, computed on the exact arcs and lines, without a mesh. Faces are half-open: where
  two bodies meet, every voxel belongs to one of them.
- Background is opaque black, as in the utility's example files. The colour of a resin follows its position among the printer's resins.
- Fewer than 30 slices, more colours than the mode takes, or a stack larger than the printer are refused before anything is written.
- A catalogue material such as FLX9960 has no published mix. It is dithered at the fraction that its mixing curve assumes,
  and `stack.json` states this.

## The skin

A voxel of a mixed body with one of its six neighbours outside is skin and stays the soft resin, also towards the connector: no
stiff droplet reaches a face. The stiff droplets removed from the skin go to the voxels just beneath, within 0.12 to 0.4 mm, one for one:
the fraction over the body, and through the wall anywhere, is the requested one. A cube whose face runs just beneath a skin
holds more than requested, and the skin next to it less. A wall too thin or too stiff for this has too small a fraction; a
warning and `stack.json` report this.
"""


def page(found: dict[str, Any]) -> str:
    """The page from the measured numbers."""
    return "\n".join(
        [
            _HEAD,
            "## Time and memory",
            "",
            "The graded dome and its connector, one core. Peak memory is of the whole process.",
            "",
            *stacks(found["stacks"]),
            "",
            "## The dither",
            "",
            "The same uniform fraction on a block of 2.6 x 5.4 x 5.4 mm by three dithers. *Cube* is the greatest error of the fraction "
            "in any cube of 1 mm (10,656 voxels). *Clumps* is the mean power of waves longer than 0.4 mm over that of white "
            "noise, *peak* the greatest of one such wave. Error diffusion passes half of a voxel's error to the next row and half to the "
            "next layer, with rows turned from layer to layer and a randomised threshold; it runs 96 layers before the block.",
            "",
            *dithers(found["dithers"]),
            "",
            "![Layers, upright sections and spectra of the three dithers](dither.svg)",
            "",
            *verdict(found["dithers"]),
            "",
            "## Raster: speed against accuracy",
            "",
            "Only the membrane. *Surface* is the distance of the boundary between voxels from the exact surface. The other programs slice "
            "the same mesh (chord tolerance 5 um) with manifold3d and fill the polygons with Pillow or matplotlib; trimesh's voxels "
            "are cubes.",
            "",
            "![Error of volume and of the surface over time](voxels.svg)",
            "",
            *rasters(found["rasters"]),
            "",
            "The raster itself bounds the surface: half a voxel's diagonal is 49 um at 27 um layers. Pillow fills every "
            "pixel that an edge touches, trimesh every cube that the surface touches.",
            "",
        ]
    )


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
        "one before. Blue noise is computed for each voxel independently, so the same voxel gets the same droplet whatever surrounds "
        "it, and a droplet stays as the fraction grows. Its block of 1.3 mm is shifted cyclically at every repetition: repeated "
        "unchanged, it would give a pattern of that size, with more than a thousand times the power of white noise in one "
        f"wave. The seams reduce the uniformity a little. Its single waves longer than 0.4 mm have at most {middling:.1f} times the power of white noise from 0.1 to 0.9 and "
        f"{max(of(blue, 'peak')):.0f} times where droplets are rare, against {max(of(diffused, 'peak')):.0f} by error diffusion "
        "and the 6 to 8 that white noise itself reaches by chance."
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
