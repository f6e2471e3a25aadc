// Two faces side by side, as "with" of two_faces.py: Figures 10 and 11 of the paper.
//
//     meshgrow mesh two_faces.geo -2
//     meshgrow mesh two_faces.geo -2 -setnumber from_vertex 1 -setnumber right_face 2
//
// The left face is mapped, so that the common edge gets as many elements as the left edge; the
// right face grows from the mesh that is there. Only the last lines are about sizes.

DefineConstant[
  from_vertex = {0, Choices{0="left edge", 1="upper left vertex"}, Name "Parameters/Sizes from"},
  right_face = {0, Choices{0="triangles", 1="quads", 2="mapped"}, Name "Parameters/Right face"},
  growth_rate = {1.2, Min 1.05, Max 2, Name "Parameters/Growth rate"},
  left_limit = {0.12, Min 0.05, Max 1, Name "Parameters/Size limit of the left face"},
  size_limit = {0.5, Min 0.1, Max 2, Name "Parameters/Size limit"}
];
height = 2;
right_width = 4;
If(from_vertex)
  size = 0.05;
  left_width = 1;
Else
  size = 0.1;
  left_width = 0.8;
EndIf
Mesh.MeshSizeMax = size_limit;

Point(1) = {0, 0, 0};
Point(2) = {0, height, 0};
Point(3) = {left_width, 0, 0};
Point(4) = {left_width, height, 0};
Point(5) = {left_width + right_width, 0, 0};
Point(6) = {left_width + right_width, height, 0};
upright[] = {1, 2, 3};
Line(1) = {1, 2};
Line(2) = {3, 4};
Line(3) = {5, 6};
Line(4) = {1, 3}; // below
Line(5) = {3, 5};
Line(6) = {2, 4}; // above
Line(7) = {4, 6};
Curve Loop(1) = {4, 2, -6, -1};
Curve Loop(2) = {5, 3, -7, -2};
left = 1;
right = 2;
common = upright[1];
Plane Surface(left) = {1};
Plane Surface(right) = {2};
Transfinite Surface {left};
Recombine Surface {left};
If(right_face == 2)
  Transfinite Surface {right};
EndIf
If(right_face > 0)
  Recombine Surface {right};
EndIf

If(from_vertex)
  source = Sprintf("Point{%g}", 2);
Else
  source = Sprintf("Curve{%g}", upright[0]);
EndIf
fixed = Sprintf("attach Surface{%g} size %g growth %g limit %g",
                left, size, growth_rate, left_limit);
DefineConstant[
  in_left = {StrCat("fixed source ", source, " ", fixed), Name "Size functions/left", ReadOnly 1},
  in_right = {Sprintf("mesh source Curve{%g} attach Surface{%g} growth %g limit %g",
                      common, right, growth_rate, size_limit),
              Name "Size functions/right", ReadOnly 1}
];
