// SPDX-License-Identifier: BSD-3-Clause
// Two blocks of 20 mm, one above the other, with groups of every dimension: for tests of the readers. Metres.
// Made for this project; README.md tells how each file here was made of it.
SetFactory("Built-in");
a = 0.02;
Point(1) = {0, 0, 0, a};
Point(2) = {a, 0, 0, a};
Point(3) = {a, a, 0, a};
Point(4) = {0, a, 0, a};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
lower[] = Extrude {0, 0, a} { Surface{1}; };
upper[] = Extrude {0, 0, a} { Surface{lower[0]}; };
Physical Volume("tissue") = {lower[1]};
Physical Volume("large tumour") = {upper[1]};
Physical Surface("base") = {1};
Physical Surface("lower half of the side") = {lower[2], lower[3], lower[4], lower[5]};
Physical Curve("edge") = {1, 2};
Physical Point("corner") = {1};
