"""The words and tables of docs/voxels.md."""

from __future__ import annotations

from typing import Any

from benchmarks.voxel_raster import OURS, TRIMESH

_HEAD = """# Voxel stacks

`make voxel-page` writes this page and its pictures.

A graded membrane cannot be ordered body by body: no printer has a resin for every point of it. GrabCAD Voxel Print takes
a stack of pictures instead, one a layer, every pixel one droplet of one base resin. `--voxels` writes it beside the build:

```console
$ pneutouch build graded-dome --voxels --voxel-mode "High Mix"
outputs/graded-dome
outputs/graded-dome-voxels
$ pneutouch show outputs/graded-dome-voxels --out section.png
$ pneutouch check graded-dome --voxels
```

`--voxel-mode` is the print mode whose layers are written; left out, the design's own, the finest. The utility must be set
to the same one. `show` holds every slice to the rules, counts the droplets and draws two sections. The printer's profile
must have a `[voxel_print]` table; `j735` has, the Objet260 takes no stacks.

![The middle of the graded dome, upright above and across below, to one scale](voxels.png)

## What is in the folder

`<name>_0.png`, `<name>_1.png` ... from the tray up, no gaps, all of one size, 32-bit RGBA, as many colours as there are
resins, and `stack.json`. It says which colour is which resin (the utility does not know: the operator maps them), the raster,
the droplets of each resin, the fraction asked and realised of each body, the seed, what was assumed, and the SHA-256 of
every slice. Bodies that are printed with the membrane are in; a plug or ring is not.

- Pixels are 25.4/600 mm wide and 25.4/300 mm deep. The dots an inch are the whole numbers next to 25400 over the profile's
  `resolution`, so 42.33 um is 600.
- Row 0 is at the greatest y, seen from above. The vendor says neither way; hold a slice to the part before a long print.
- A voxel is of the body that its centre lies in, decided on the exact arcs and lines, without a mesh. Faces are half-open: where
  two bodies meet, every voxel is of one of them.
- Background is opaque black, as in the utility's own files. A resin has the colour of its place among the printer's resins.
- Fewer than 30 slices, more colours than the mode takes, a stack larger than the printer: refused before anything is written.
- A catalogue material such as FLX9960 has no published mix. It is dithered at the fraction that its mixing curve assumes,
  and `stack.json` says so.

## The skin

A voxel of a mixed body with one of its six neighbours outside is skin and stays the soft resin, towards the connector too: no
stiff droplet reaches a face. What the skin lacks goes to the voxels just beneath, within 0.12 to 0.4 mm, droplet for droplet:
the fraction over the body, and through the wall anywhere, is the one asked for. A cube whose face runs just beneath a skin
holds more than asked, and the skin beside it less. A wall too thin or too stiff for that falls short, which is said as a
warning and in `stack.json`.
"""


def page(found: dict[str, Any]) -> str:
    """The page from the measured numbers."""
    return "\n".join([
        _HEAD, "## What it takes", "",
        "The graded dome and its connector, one core. Peak memory is of the whole process.", "", *stacks(found["stacks"]), "",
        "## The dither", "",
        "The same even fraction on a block of 2.6 x 5.4 x 5.4 mm by three dithers. *Cube* is the worst error of the fraction "
        "in any cube of 1 mm (10,656 voxels). *Clumps* is the mean power of waves longer than 0.4 mm over that of white "
        "noise, *peak* the greatest of one such wave. Error diffusion passes half of a voxel's error to the next row and half to the "
        "next layer, rows turning from layer to layer, the threshold shaken; it is given 96 layers to get under way.", "",
        *dithers(found["dithers"]), "",
        "![Layers, upright sections and spectra of the three dithers](dither.svg)", "",
        *verdict(found["dithers"]), "",
        "## Raster: speed against accuracy", "",
        "The membrane alone. *Surface* is the distance of the boundary between voxels from the exact surface. The peers slice "
        "our mesh (chord tolerance 5 um) with manifold3d and fill the polygons with Pillow or matplotlib; trimesh's voxels "
        "are cubes.", "",
        "![Error of volume and of the surface over time](voxels.svg)", "",
        *rasters(found["rasters"]), "",
        "The raster itself bounds the surface: half a voxel's diagonal is 49 um at 27 um layers. Pillow fills every "
        "pixel that an edge touches, trimesh every cube that the surface touches.", "",
    ])  # fmt: skip


def stacks(rows: list[dict[str, Any]]) -> list[str]:
    lines = ["| mode | slices | time s | peak MB | files MB | reading s | volume off | fraction asked, realised | worst cube |",
             "|---|---|---|---|---|---|---|---|---|"]  # fmt: skip
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
        f"{row['seconds']:.3f} |" for row in rows
    ]  # fmt: skip


def verdict(rows: list[dict[str, Any]]) -> list[str]:
    """What the numbers say."""

    def of(method: str, key: str) -> list[float]:
        return [row[key] for row in rows if row["method"] == method]

    blue, diffused = "blue noise", "error diffusion"
    middling = max(row["peak"] for row in rows if row["method"] == blue and 0.1 <= row["fraction"] <= 0.9)
    slower = min(of(diffused, "seconds")) / max(of(blue, "seconds"))
    return [
        f"Blue noise is what stacks are made with: at most {max(of(blue, 'cube')):.2%} off in any cube, against "
        f"{max(of(diffused, 'cube')):.2%} by error diffusion, which is {slower:.0f} times slower here because its rows wait for "
        "one another. Blue noise needs nothing from its neighbours, so the same voxel gets the same droplet whatever is around "
        "it, and a droplet once there stays as the fraction grows. Its block of 1.3 mm is rolled anew wherever it stands: side by "
        "side as it is, it would come out as a pattern of that size, of more than a thousand times white noise's power in one "
        f"wave. The seams cost some evenness. Its single waves longer than 0.4 mm have at most {middling:.1f} times white noise's power from 0.1 to 0.9 and "
        f"{max(of(blue, 'peak')):.0f} times where droplets are rare, against {max(of(diffused, 'peak')):.0f} by error diffusion "
        "and the 6 to 8 that white noise itself reaches by chance."
    ]  # fmt: skip


def rasters(rows: list[dict[str, Any]]) -> list[str]:
    lines = ["| way | raster | time s | volume | surface mean um | greatest um |", "|---|---|---|---|---|---|"]
    for row in rows:
        cube = row["method"] == TRIMESH
        step = f"cubes of {row['layer_um']:g} um" if cube else f"{row['layer_um']:g} um layers, x {row['coarser']:g}"
        name = f"**{row['method']}**" if row["method"] == OURS else row["method"]
        lines.append(
            f"| {name} | {step} | {row['seconds']:.3f} | {row['volume']:+.2%} | {1e3 * row['mean']:.0f} | {1e3 * row['most']:.0f} |"
        )
    return lines
