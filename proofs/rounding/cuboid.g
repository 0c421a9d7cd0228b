# Claim C6. Rounding of the moments of a cuboid's cell, models/cuboid.cpp:
#   const Eigen::Vector3d width = upper - lower;
#   return {width.prod(), 0.5 * (lower + upper),
#           (width.array().square() / 12.0).matrix().asDiagonal()};
# Bounds are doubles in [-1/2, 1/2]; a width is at least 2^-200, so that nothing underflows.
@rnd = float<ieee_64, ne>;

ax = rnd(dummy1);  bx = rnd(dummy2);
ay = rnd(dummy3);  by = rnd(dummy4);
az = rnd(dummy5);  bz = rnd(dummy6);

wx rnd= bx - ax;   Wx = bx - ax;
wy rnd= by - ay;   Wy = by - ay;
wz rnd= bz - az;   Wz = bz - az;

volume rnd= wx * wy * wz;
Volume = Wx * Wy * Wz;
centre rnd= 0.5 * (ax + bx);
Centre = 0.5 * (ax + bx);
variance rnd= (wx * wx) / 12;
Variance = (Wx * Wx) / 12;

{ ax in [-0.5, 0.5] /\ bx in [-0.5, 0.5] /\ Wx in [1b-200, 1]
/\ Wy in [1b-200, 1] /\ Wz in [1b-200, 1]
->
# Volume: five roundings. Variance: four. Both relative to themselves, however thin the cell.
   volume -/ Volume in [-6b-53, 6b-53]
/\ variance -/ Variance in [-5b-53, 5b-53]
# Centre: relative to the canonical cuboid, whose side is one.
/\ |centre - Centre| <= 1b-54 }
