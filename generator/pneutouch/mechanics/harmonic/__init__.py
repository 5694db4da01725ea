"""The solid with harmonics around its axis, for contact off the axis: an object beside the axis, or a plate that leans.

The position of a node at the angle t around the axis is r = sum of r_m cos(m t), z = sum of z_m cos(m t) and, along the
circle, the sum of s_m sin(m t), over m = 0 to an order M: for scenes symmetric about the plane of t = 0.
"""
