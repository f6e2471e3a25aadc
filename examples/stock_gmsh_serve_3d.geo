// As stock_gmsh_serve.geo, in three dimensions: a block that is meshed first, finer on one side, and
// the box around it, which grows from the mesh of the block.
//
//     gmsh - examples/stock_gmsh_serve_3d.geo

SetFactory("OpenCASCADE");
Box(1) = {-3, -3, -3, 6, 6, 6};
Box(2) = {-1, -1, -1, 2, 2, 2};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
outer = 3;                                             // what the fragments leave of the outer box
inner = 2;
faces() = Boundary{ Volume{inner}; };

// 1. The faces of the block, by a field of Gmsh's own, and those of the box, which do not matter yet.
Mesh.SaveAll = 1;
Mesh.MshFileVersion = 4.1;
Mesh.MeshSizeExtendFromBoundary = 0;
Field[1] = MathEval;
Field[1].F = "0.14 - 0.16 * x / (1 + x * x)";
Background Field = 1;
Mesh 2;
Save "stock_gmsh_serve_3d_block.msh";

// 2. Sizes that grow from it into both volumes and what bounds them.
mesh = StrCat(CurrentDirectory, "stock_gmsh_serve_3d_block.msh");
grown = Sprintf("mesh source Surface{%g:%g} attach Volume{%g,%g} growth 1.2 limit 1",
                faces(0), faces(5), inner, outer);
Field[2] = ExternalProcess;
Field[2].CommandLine = StrCat("meshgrow serve '", mesh, "' --size-function '", grown, "'");
Background Field = 2;

// 3. All surfaces once more, now by the field, and the volumes.
Mesh 2;
Mesh 3;
Save "stock_gmsh_serve_3d.msh";
