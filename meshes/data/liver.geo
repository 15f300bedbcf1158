// SPDX-License-Identifier: BSD-3-Clause
// A smooth body that tapers from a thick right end to a thin left one, about the size and shape of a liver; no patient's.
// Metres; x runs from right to left, the origin lies in the thickest section. "base" is the flat right end, where it may
// be held, "skin" all of the surface.
// Made for this project. liver_fine.msh, liver_medium.msh and liver_coarse.msh:
//   gmsh -3 liver.geo -setnumber h 0.0165 -o liver_fine.msh      (medium: 0.023, coarse: 0.032; Gmsh 4.8.4)
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.023 ];
Macro Section  // an ellipse across x, its half axes along y and z
  curve = newc;
  Ellipse(curve) = {0, 0, 0, ry, rz};
  Rotate{ {0, 0, 1}, {0, 0, 0}, Pi / 2 }{ Curve{curve}; }
  Rotate{ {0, 1, 0}, {0, 0, 0}, Pi / 2 }{ Curve{curve}; }
  Translate{x, y, z}{ Curve{curve}; }
  loop = newll;
  Curve Loop(loop) = {curve};
  sections() += loop;
Return
sections() = {};
x = -0.075; y = 0;     z = 0;     ry = 0.032; rz = 0.024; Call Section;
x = -0.045; y = 0;     z = 0;     ry = 0.062; rz = 0.043; Call Section;
x = 0;      y = 0;     z = 0;     ry = 0.070; rz = 0.050; Call Section;
x = 0.045;  y = 0.004; z = 0.004; ry = 0.058; rz = 0.040; Call Section;
x = 0.09;   y = 0.010; z = 0.010; ry = 0.042; rz = 0.027; Call Section;
x = 0.135;  y = 0.014; z = 0.012; ry = 0.026; rz = 0.017; Call Section;
ThruSections(1) = sections();
Delete{ Curve{:}; }
base() = Surface In BoundingBox{-0.076, -1, -1, -0.074, 1, 1};
Physical Volume("tissue") = {1};
Physical Surface("skin") = Surface{:};
Physical Surface("base") = base();
Mesh.CharacteristicLengthMax = h;
Mesh.CharacteristicLengthMin = h;
Mesh.MshFileVersion = 2.2;
