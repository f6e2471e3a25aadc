// Size functions in a .geo: strings that stock gmsh shows in its window and otherwise ignores.
//
//     meshgrow mesh size_functions.geo -3
//
// A pipe through a block: the wall of the pipe gets a size, and the block grows from the mesh of
// that wall. The numbers may be changed in gmsh's window, or with -setnumber.

SetFactory("OpenCASCADE");
DefineConstant[
  wall_size = {0.04, Min 0.01, Max 0.2, Name "Parameters/Size on the wall"},
  growth = {1.2, Min 1.05, Max 2, Name "Parameters/Growth rate"},
  limit = {0.3, Min 0.1, Max 1, Name "Parameters/Size limit"}
];

Box(1) = {-1, -1, 0, 2, 2, 3};
Cylinder(2) = {0, 0, 0, 0, 0, 3, 0.3};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
pipe() = Volume In BoundingBox{-0.31, -0.31, -0.01, 0.31, 0.31, 3.01};
block() = Volume{:};
block() -= pipe();
wall() = Surface In BoundingBox{-0.31, -0.31, -0.01, 0.31, 0.31, 3.01};
wall() -= Surface In BoundingBox{-1.01, -1.01, -0.01, 1.01, 1.01, 0.01};
wall() -= Surface In BoundingBox{-1.01, -1.01, 2.99, 1.01, 1.01, 3.01};
Physical Volume("pipe") = pipe();
Physical Volume("block") = block();
Physical Surface("wall") = wall();

// Tags come out of the script; physical groups go by name, without quotes.
DefineConstant[
  in_pipe = {Sprintf("fixed source Surface{%g} attach Volume{%g} size %g growth %g limit %g",
                     wall(0), pipe(0), wall_size, growth, limit),
             Name "Size functions/pipe", ReadOnly 1},
  in_block = {Sprintf("mesh source Physical Surface{wall} attach Physical Volume{block} growth %g limit %g",
                      growth, limit),
              Name "Size functions/block", ReadOnly 1}
];
