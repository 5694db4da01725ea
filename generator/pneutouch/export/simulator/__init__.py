"""A sensor for simulators of machines: MuJoCo's MJCF with the force of its dome, and a link of URDF."""
