// Refinement from an earlier run: the surface mesh stays, the volume is meshed anew.
//
//     meshgrow mesh earlier_run.geo -3 --remesh -o later_run.msh
//
// in the folder where earlier_run.py has written its files (examples/out).
//
// As the later run of earlier_run.py, which explains it and writes the two files that are read here.
// --remesh throws away all meshes but those of sources.

SetFactory("OpenCASCADE");
DefineConstant[
  growth_rate = {1.5, Min 1.05, Max 2, Name "Parameters/Growth rate"},
  size_limit = {2, Min 0.1, Max 4, Name "Parameters/Size limit"}
];
Merge "earlier_run.brep";
Merge "earlier_run_study.msh";

DefineConstant[
  volume = {Sprintf("mesh source Surface{:} attach Volume{:} growth %g limit %g", growth_rate, size_limit),
            Name "Size functions/volume", ReadOnly 1}
];
