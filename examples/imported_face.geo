// A volume grows from a face mesh that comes from a file, bounded by plane faces below it: as
// imported_face.py, which writes the file imported_face_A.msh.
//
//     meshgrow mesh imported_face.geo -3 --calibrate
//
// in the folder where imported_face.py has written its files (examples/out).
//
// The face is discrete: Gmsh and meshgrow keep it, node by node.

DefineConstant[
  growth_rate = {1.2, Min 1.05, Max 2, Name "Parameters/Growth rate"},
  size_limit = {5, Min 0.1, Max 10, Name "Parameters/Size limit"},
  depth = {3, Min 1, Max 5, Name "Parameters/Depth"}
];

Merge "imported_face_A.msh";
face() = Surface{:};
DefineConstant[
  from_face = {Sprintf("mesh source Surface{%g} attach Volume{1} growth %g limit %g", face(0),
                       growth_rate, size_limit),
               Name "Size functions/from face A", ReadOnly 1}
];

// Corners of the face and its curves, as the file numbers them. Only plane faces may have
// discrete curves on their boundary.
corner() = {1, 4, 6, 5};
side() = {1, 3, -4, -2};
For i In {0:3}
  place() = Point{corner(i)};
  below(i) = newp;
  Point(below(i)) = {place(0), place(1), -depth};
EndFor
For i In {0:3}
  upright(i) = newl;
  Line(upright(i)) = {corner(i), below(i)};
EndFor
For i In {0:3}
  bottom(i) = newl;
  Line(bottom(i)) = {below(i), below((i + 1) % 4)};
EndFor
For i In {0:3}
  loop = newll;
  Curve Loop(loop) = {side(i), upright((i + 1) % 4), -bottom(i), -upright(i)};
  around(i) = news;
  Plane Surface(around(i)) = {loop};
EndFor
loop = newll;
Curve Loop(loop) = {bottom()};
around(4) = news;
Plane Surface(around(4)) = {loop};
shell = newsl;
Surface Loop(shell) = {face(), around()};
Volume(1) = {shell};
