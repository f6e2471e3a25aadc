// Sizes of meshgrow in an unchanged Gmsh, as a view that is its background field.
//
// 1. Write the sizes beside this file (the model is read without them then):
//
//      meshgrow field stock_gmsh_view.geo -o sizes.pos --size-function \
//        'curvature source Surface{:} attach Volume{1} angle 15 growth 1.3 limit 0.4'
//
// 2. Mesh with any Gmsh, in the GUI too:
//
//      gmsh -3 stock_gmsh_view.geo -o stock_gmsh_view.msh
//
// The same from Python: field.write_view("sizes.pos").

SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 4, 2, 1};
Cylinder(2) = {1, 1, -1, 0, 0, 3, 0.5};
Cylinder(3) = {3, 1, -1, 0, 0, 3, 0.15};
BooleanDifference{ Volume{1}; Delete; }{ Volume{2, 3}; Delete; }

If (FileExists("sizes.pos"))
  Merge "sizes.pos";
  Field[1] = PostView;
  Field[1].ViewIndex = 0;
  Background Field = 1;
  // The view says how sizes grow: nothing else has to.
  Mesh.MeshSizeExtendFromBoundary = 0;
  Mesh.MeshSizeFromPoints = 0;
EndIf
