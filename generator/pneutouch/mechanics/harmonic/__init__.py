"""The solid with harmonics around its axis: an object off the axis, or a plate that leans.

Positions of a node are r = sum of r_m cos(m t), z = sum of z_m cos(m t) and a part along the circle, sum of s_m
sin(m t), over m = 0 to an order M, t the angle around the axis: scenes that are symmetric about the plane of t = 0.
"""
