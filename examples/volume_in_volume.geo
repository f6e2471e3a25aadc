// A volume inside another, as "new" of volume_in_volume.py: Figures 8 and 9 of the paper.
//
//     meshgrow mesh volume_in_volume.geo -3 --evaluator grid
//     meshgrow mesh volume_in_volume.geo -3 --evaluator grid -setnumber not_similar 1
//
// Each volume has a proximity and a curvature size function of its own, with the paper's numbers;
// the mesh of the common faces, made fine by the narrow gap of volume.1, grows on into volume.2.

SetFactory("OpenCASCADE");
DefineConstant[
  not_similar = {0, Choices{0, 1}, Name "Parameters/Not similar"},
  coarse = {1, Min 1, Max 4, Name "Parameters/Times coarser"}
];
cells_per_gap = 3 / coarse;
angle = 25 * coarse;
growth_rate = 1.2;
size_limit = 2 * coarse;

If(not_similar) // an ellipsoid in a box; its tip is at x = 8, the wall at 8.6
  Sphere(1) = {0, 0, 0, 5};
  Dilate{ {0, 0, 0}, {1.6, 1, 1} }{ Volume{1}; }
  Box(2) = {-11, -6.5, -6.5, 19.6, 13, 13};
Else // two rounded cubes, a gap of 1 between them
  Box(1) = {-4, -4, -4, 8, 8, 8};
  edges() = Abs(Boundary{ Surface{ Abs(Boundary{ Volume{1}; }) }; });
  edges() = Unique(edges());
  Fillet{1}{edges()}{2}
  Box(2) = {-5, -5, -5, 10, 10, 10};
  edges() = Abs(Boundary{ Surface{ Abs(Boundary{ Volume{2}; }) }; });
  edges() = Unique(edges());
  Fillet{2}{edges()}{3}
EndIf
BooleanFragments{ Volume{2}; Delete; }{ Volume{1}; Delete; }
inner = 1;
volumes() = Volume{:};
volumes() -= inner;
outer = volumes(0);
common() = Abs(Boundary{ Volume{inner}; });
Physical Volume("volume.1") = outer;
Physical Volume("volume.2") = inner;
Physical Surface("common") = common();

grow = Sprintf("growth %g limit %g", growth_rate, size_limit);
gap = StrCat(Sprintf("cells %.17g ", cells_per_gap), grow);
turn = StrCat(Sprintf("angle %g ", angle), grow);
of_1 = Sprintf("source Volume{%g} attach Volume{%g} ", outer, outer);
of_2 = Sprintf("source Volume{%g} attach Volume{%g} ", inner, inner);
DefineConstant[
  sfunc1 = {StrCat("proximity ", of_1, gap), Name "Size functions/sfunc.1", ReadOnly 1},
  sfunc2 = {StrCat("curvature ", of_1, turn), Name "Size functions/sfunc.2", ReadOnly 1},
  sfunc3 = {StrCat("proximity ", of_2, gap), Name "Size functions/sfunc.3", ReadOnly 1},
  sfunc4 = {StrCat("curvature ", of_2, turn), Name "Size functions/sfunc.4", ReadOnly 1},
  sfunc5 = {StrCat(Sprintf("mesh source Physical Surface{common} attach Volume{%g} ", inner), grow),
            Name "Size functions/sfunc.5", ReadOnly 1}
];
