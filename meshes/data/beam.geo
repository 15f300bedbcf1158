// SPDX-License-Identifier: BSD-3-Clause
// A beam of soft tissue with a stiff round inclusion. Metres; the end to clamp, "base", lies in x = 0, centred on the
// x axis.
// Made for this project. beam.msh: gmsh -3 beam.geo -o beam.msh   (Gmsh 4.8.4)
SetFactory("OpenCASCADE");
Box(1) = {0, -0.02, -0.02, 0.16, 0.04, 0.04};
Sphere(2) = {0.1, 0, 0, 0.012};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
base() = Surface In BoundingBox{-1e-6, -0.03, -0.03, 1e-6, 0.03, 0.03};
Physical Volume("tissue") = {3};
Physical Volume("tumour") = {2};
Physical Surface("base") = {base()};
Mesh.CharacteristicLengthMax = 0.01;
Mesh.CharacteristicLengthMin = 0.005;
Mesh.MshFileVersion = 2.2;
