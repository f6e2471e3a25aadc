// Stock Gmsh, nothing installed into it, and sizes that grow from a mesh:
//
//     gmsh - examples/stock_gmsh_serve.geo          (or open it in Gmsh's window)
//
// with the program meshgrow on the PATH (MESHGROW_GMSH_LIB names a libgmsh where it does not find
// one). Gmsh waits for ever if there is no such program: its shell then says "not found".
// A plate with a slot whose rim has a mesh of its own, fine at its tips; the plate grows from it.

SetFactory("OpenCASCADE");

Rectangle(1) = {0, 0, 0, 8, 4};
Disk(2) = {4, 2, 0, 1.5, 0.4};
BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
rim() = Boundary{ Surface{3}; };
rim = rim(4);                                          // the slot's, the only one that is not straight
Transfinite Curve{rim} = 121 Using Bump 0.1;

// 1. Mesh what sizes grow from, and keep it in a file. All entities go into it, also those without a
//    mesh, and without regard to physical groups.
Mesh.SaveAll = 1;
Mesh.MshFileVersion = 4.1;
Mesh 1;
Save "stock_gmsh_serve_rim.msh";

// 2. Sizes come from a program that Gmsh starts by `sh -c` and asks through pipes. Single quotes
//    within the double ones keep the parts of its command line together; 1023 characters are all
//    that a string may have, so many size functions had better come from a file (--size-functions).
mesh = StrCat(CurrentDirectory, "stock_gmsh_serve_rim.msh");
grown = Sprintf("mesh source Curve{%g} attach Surface{3} growth 1.2 limit 0.5", rim);
Field[1] = ExternalProcess;
Field[1].CommandLine = StrCat("meshgrow serve '", mesh, "' --size-function '", grown, "'");
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;                   // the field alone says what is inside

// 3. The other curves once more, now by the field, and the plate. The rim has its number of nodes.
Mesh 1;
Mesh 2;
Save "stock_gmsh_serve.msh";
