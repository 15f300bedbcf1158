// SPDX-License-Identifier: BSD-3-Clause
// A ball of tissue. Metres; the centre is the origin.
// Made for this project. ball.msh: gmsh -3 ball.geo -o ball.msh   (Gmsh 4.8.4)
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 0.05};
Physical Volume("tissue") = {1};
Physical Surface("skin") = {1};
Mesh.CharacteristicLengthMax = 0.0115;
Mesh.CharacteristicLengthMin = 0.0115;
Mesh.MshFileVersion = 2.2;
