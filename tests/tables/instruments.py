"""One recording as ten instruments write it. The layouts are those of the makers' documentation and of exports in public use.

LabVIEW: NI, Specification for the LabVIEW Measurement File (.lvm), ni.com/tutorial/4139. Its form with commas: the sample
file of github.com/ladisk/lvm_read, pull request 15. Instron Bluehill, Specimen_RawData_1.csv: an optional block of
"General : name,value" lines, an empty line, a row of names and a row of units (R package bluer, help page bluer).
ZwickRoell testXpert: names Prüfzeit, Standardweg, Standardkraft with a row of units below them, as public readers of its
exports expect them. MTS: Series 793 MultiPurpose TestWare manual, page 136, for the first line of specimen.dat; TestSuite
for names and units in two rows. TDMS: NI, TDMS File Format Internal Structure; unit_string, wf_start_offset, wf_increment.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

LBF, PSI, INCH = 4.4482216152605, 6.894757293168, 25.4


def rows(columns, decimals, separator=",", decimal=".", end="\n", quote=""):
    """Lines of numbers: ``columns`` (k, n) with so many decimals each."""
    forms = [f"{quote}%.{count}f{quote}" for count in decimals]
    return "".join(
        separator.join(form % value for form, value in zip(forms, row, strict=True)).replace(".", decimal) + end
        for row in np.asarray(columns).T
    )


def plain(folder, t, z, f, p):
    """The project's own CSV."""
    return text(folder / "plain.csv", "time_s,position_mm,force_N,pressure_kPa\n" + rows([t, z, f, p], (3, 5, 6, 6)))


def labview(folder, t, z, f, p):
    """LabVIEW measurement file with tabs; the last column is that of remarks, which rows leave out."""
    count = t.size
    head = (
        "LabVIEW Measurement\t\r\nWriter_Version\t2\r\nReader_Version\t2\r\nSeparator\tTab\r\nDecimal_Separator\t.\r\n"
        "Multi_Headings\tNo\r\nX_Columns\tOne\r\nTime_Pref\tRelative\r\nOperator\tlab\r\nDate\t2026/03/04\r\n"
        "Time\t10:11:12.5000000000000000000\r\n***End_of_Header***\t\r\n\t\r\nChannels\t3\t\t\t\r\n"
        f"Samples\t{count}\t{count}\t{count}\t\r\nDate\t2026/03/04\t2026/03/04\t2026/03/04\t\r\n"
        "Time\t10:11:12.5\t10:11:12.5\t10:11:12.5\t\r\nY_Unit_Label\tmm\tN\tPa\t\r\nX_Dimension\tTime\tTime\tTime\t\r\n"
        "X0\t0.0000000000000000E+0\t0.0000000000000000E+0\t0.0000000000000000E+0\t\r\n"
        "Delta_X\t0.001000\t0.001000\t0.001000\t\r\n***End_of_Header***\t\t\t\t\r\n"
        "X_Value\tStage position\tLoad cell\tPressure\tComment\r\n"
    )
    return text(folder / "labview.lvm", head + rows([t, z, f, p * 1e3], (6, 5, 6, 3), "\t", end="\r\n"))


def labview_without_times(folder, t, z, f, p):
    """LabVIEW measurement file with commas and no column of times: begin and step stand in its header."""
    step = f"{t[1] - t[0]:.6E}"
    head = (
        "LabVIEW Measurement,\nWriter_Version,2\nReader_Version,2\nSeparator,Comma\nDecimal_Separator,.\n"
        "Multi_Headings,No\nX_Columns,No\nTime_Pref,Relative\nOperator,lab\nDate,2026/03/04\nTime,13:06:46.26\n"
        "***End_of_Header***,\n,\nChannels,3,,,,\nSamples,4,4,4,\nDate,2026/03/04,2026/03/04,2026/03/04,\n"
        "Time,13:06:46.26,13:06:46.26,13:06:46.26,\nY_Unit_Label,Newton,kPa,um,\nX_Dimension,Time,Time,Time,\n"
        f"X0,{t[0]:.4E},{t[0]:.4E},{t[0]:.4E},\nDelta_X,{step},{step},{step},\n***End_of_Header***,,,,\n"
        "X_Value,Force,Pressure,Position,Comment\n"
    )
    lines = rows([f, p, z * 1e3], (6, 6, 2)).splitlines()
    return text(folder / "no-times.lvm", head + "".join(f",{line},\n" for line in lines))


def instron(folder, t, z, f, p):
    """Bluehill raw data: quoted cells, names and units in two rows, compression counted negative."""
    head = (
        'General : Start date,"3/4/2026 10:11:12 AM"\nGeneral : Sample note 1,"dome, batch 3"\n'
        'Specimen : Specimen label,"tip 1"\nTest : Rate 1,0.5000,mm/s\n\n'
        '"Time","Compressive extension","Compressive load","Pressure gauge"\n"(sec)","(mm)","(N)","(psi)"\n'
    )
    return text(folder / "Specimen_RawData_1.csv", head + rows([t, z, f, p / PSI], (3, 5, 6, 8), quote='"'))


def zwick(folder, t, z, f, p):
    """testXpert: semicolons, decimal commas, CP1252, German names, units in a row of their own."""
    head = (
        "Prüfprotokoll;\r\nPrüfer;Müller\r\nProbenbezeichnung;Kuppel 1\r\nVorkraft;0,1;N\r\n\r\n"
        "Prüfzeit;Standardweg;Standardkraft;Innendruck\r\ns;µm;N;mbar\r\n"
    )
    body = rows([t, z * 1e3, f, p * 10], (3, 2, 6, 5), ";", ",", "\r\n")
    return text(folder / "zwick.txt", head + body, "cp1252")


def mts(folder, t, z, f, p):
    """Specimen.dat of the Series 793 in German: its first line states tabs (2) and decimal commas."""
    head = (
        "MTS793|MPT|DEU|1|2|,|.|:|49|1|1|A\n\n"
        f"Data Acquisition: Timed\t\t\t\tTime:\t{t[-1]:.4f}\tSec\t04.03.2026 10:11:12\n"
        + "Running Time\tAxial Displacement\tAxial Force\tCavity Pressure\nSec\tmm\tkN\tkPa\n"
    )
    return text(folder / "specimen.dat", head + rows([t, z, f * 1e-3, p], (3, 5, 9, 6), "\t", ","))


def mts_testsuite(folder, t, z, f, p):
    """TestSuite's export with US units and rounded brackets, UTF-16 with a byte order mark."""
    head = "Test Run Name:\tdome 1\nDate:\t3/4/2026 10:11:12 AM\n\nTime\tCrosshead\tLoad\tPressure\n(s)\t(in)\t(lbf)\t(psi)\n"
    body = rows([t, z / INCH, f / LBF, p / PSI], (3, 8, 8, 8), "\t")
    return text(folder / "testsuite.txt", head + body, "utf-16")


def logger(folder, t, z, f, p):
    """A microcontroller's log: units in the names, time in milliseconds, force in grams, no spaces."""
    body = rows([t * 1e3, z, f / 9.80665e-3, p * 1e3 / 133.322387415], (0, 5, 5, 6))
    return text(folder / "logger.log", "time_ms,pos_mm,load_g,p_mmHg\n" + body)


def savetxt(folder, t, z, f, p):
    """numpy.savetxt: a header with a number sign, columns between spaces."""
    path = folder / "savetxt.txt"
    np.savetxt(path, np.stack([t, z, f, p]).T, "%.6f", header="t[s] z[mm] F[N] p[kPa]")
    return path


def excel(folder, t, z, f, p):
    """TestXpert's or Bluehill's workbook: a sheet of results, a sheet of values with names and units in two rows."""
    from openpyxl import Workbook

    book = Workbook()
    book.active.title = "Results"
    book.active.append(["Specimen", "Fmax", "Remark"])
    book.active.append(["tip 1", "N", "ok"])
    sheet = book.create_sheet("Specimen 1")
    for row in (["Specimen 1"], ["Test time", "Stroke", "Standard force", "Pressure"], ["s", "mm", "N", "bar"]):
        sheet.append(row)
    for row in np.round(np.stack([t, z, f, p / 100]), 8).T.tolist():
        sheet.append(row)
    path = folder / "excel.xlsx"
    book.save(path)
    return path


def tdms(folder, t, z, f, p):
    """LabVIEW's binary file: channels with units and a clock, in two segments, beside a group of another rate."""
    from nptdms import ChannelObject, TdmsWriter

    def channels(part):
        clock = {"wf_start_offset": float(t[0]), "wf_increment": float(t[1] - t[0])}
        for name, unit, values in (("Position", "mm", z), ("Force", "N", f), ("Pressure", "hPa", p * 10)):
            yield ChannelObject("Run", name, values[part], {"unit_string": unit, **clock})

    path, half = folder / "run.tdms", t.size // 2
    with TdmsWriter(path) as writer:
        writer.write_segment([*channels(slice(None, half)), ChannelObject("Info", "note", ["dome 1"])])
        writer.write_segment(list(channels(slice(half, None))))
    return path


def parquet(folder, t, z, f, p):
    """A table of pandas with units in brackets."""
    import pandas as pd

    path = folder / "run.parquet"
    pd.DataFrame({"Time (s)": t, "Position mm": z, "Load [N]": f, "P_kPa": p}).to_parquet(path)
    return path


def text(path: Path, content: str, encoding="utf-8"):
    path.write_bytes(content.encode(encoding))
    return path


INSTRUMENTS = (
    labview,
    labview_without_times,
    instron,
    zwick,
    mts,
    mts_testsuite,
    logger,
    savetxt,
    excel,
    tdms,
    parquet,
)
