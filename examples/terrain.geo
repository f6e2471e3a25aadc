// The air above a terrain: the measured triangles are kept, the volume grows from them.
//
//     meshgrow mesh terrain.geo -3 -o terrain.msh
//
// in the folder where terrain.py has written its files (examples/out).
//
// As terrain.py, which explains it and has written terrain_surface.msh: a discrete surface with
// four curves between four points. Lengths are in metres.

Merge "terrain_surface.msh";
DefineConstant[
  top_height = {1000, Min 300, Max 3000, Name "Parameters/Top of the air"},
  growth = {1.2, Min 1.05, Max 2, Name "Parameters/Growth rate"},
  limit = {250, Min 100, Max 1000, Name "Parameters/Size limit"}
];
Mesh.MeshSizeMax = limit;
terrain = 1; // Surface{1}; its Curve{i} goes from Point{i} to the next of the four

For i In {1:4}
  xyz() = Point{i};
  above(i) = newp;
  Point(above(i)) = {xyz(0), xyz(1), top_height};
  upright(i) = newc;
  Line(upright(i)) = {i, above(i)};
EndFor
For i In {1:4}
  edge(i) = newc;
  Line(edge(i)) = {above(i), above(i % 4 + 1)};
EndFor
For i In {1:4}
  loop = newll;
  Curve Loop(loop) = {i, upright(i % 4 + 1), -edge(i), -upright(i)};
  side(i) = news;
  Plane Surface(side(i)) = {loop};
EndFor
loop = newll;
Curve Loop(loop) = {edge(1), edge(2), edge(3), edge(4)};
top = news;
Plane Surface(top) = {loop};
shell = newsl;
Surface Loop(shell) = {terrain, top, side(1), side(2), side(3), side(4)};
air = newv;
Volume(air) = {shell};

DefineConstant[
  air_sizes = {Sprintf("mesh source Surface{%g} attach Volume{%g} growth %g limit %g",
                       terrain, air, growth, limit),
               Name "Size functions/air", ReadOnly 1}
];
