// A crack: an inclined ellipse inside a block, finely meshed first; the volume grows from it.
//
//     meshgrow mesh crack.geo -3 -o crack.msh
//
// As crack.py and crack.cpp, which explain it. Lengths are in millimetres.

SetFactory("OpenCASCADE");
DefineConstant[ coarse = {1, Min 0.5, Max 4, Name "Parameters/Coarser, times"} ];
side = 100;
length = 50;
width = 30;
tilt = Pi / 4;
front_size = 0.5 * coarse;
crack_growth = 1.3;
crack_limit = 3 * coarse;
block_growth = 1.2;
block_limit = 12 * coarse;
Mesh.MeshSizeMax = block_limit;

block = 1;
Box(block) = {-side / 2, -side / 2, -side / 2, side, side, side};
crack = newreg;
Disk(crack) = {0, 0, 0, length / 2, width / 2};
Rotate{ {1, 0, 0}, {0, 0, 0}, tilt }{ Surface{crack}; }
Surface{crack} In Volume{block};
front() = Abs(Boundary{ Surface{crack}; });

DefineConstant[
  crack_sizes = {Sprintf("fixed source Curve{%g} attach Surface{%g} size %g growth %g limit %g",
                         front(0), crack, front_size, crack_growth, crack_limit),
                 Name "Size functions/crack", ReadOnly 1},
  block_sizes = {Sprintf("mesh source Surface{%g} attach Volume{%g} growth %g limit %g",
                         crack, block, block_growth, block_limit),
                 Name "Size functions/block", ReadOnly 1}
];
