"""Parts of the connector that a design names in more than one key: its tube and its mount."""

from pneutouch.catalogue.library import Library
from pneutouch.errors import InputError, shown
from pneutouch.spec.design import DesignFile
from pneutouch.spec.part import AnyMount, Sleeve, Tube


def tube_of(design: DesignFile, where: str, library: Library) -> Tube:
    """The tube that the design names, else the usual one of its port. Raises InputError if it does not fit."""
    port = library.load("ports", design.connector.port, file=where, key="connector.port")
    name = design.pneumatics.tube
    if name is not None:
        library.load("tubes", name, file=where, key="pneumatics.tube")
        if name not in port.tubes:
            raise InputError(
                f"the port {design.connector.port} takes {', '.join(port.tubes)}",
                file=where,
                key="pneumatics.tube",
                value=name,
                remedy="give one of these, or another connector.port",
            )
    tube: Tube = library.load("tubes", name or port.tubes[0], file=where, key="tubes of connector.port")
    return tube


def mount_of(design: DesignFile, where: str, library: Library) -> AnyMount:
    """The mount that the design names; a sleeve for the finger that it gives."""
    chosen, finger = design.connector.mount, design.connector.finger_diameter_mm
    mount: AnyMount = library.load("mounts", chosen, file=where, key="connector.mount")
    if finger is None:
        return mount
    if not isinstance(mount, Sleeve):
        sleeves = [name for name in library.paths("mounts") if isinstance(library.load("mounts", name), Sleeve)]
        raise InputError(
            f"connector.mount = {shown(chosen)} goes over no finger",
            file=where,
            key="connector.finger_diameter_mm",
            value=finger,
            remedy=f"take connector.mount = {' or '.join(sleeves)}, or leave it out",
        )
    return mount.for_finger(finger)
