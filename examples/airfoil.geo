// NACA 0012 with small elements at the nose, at the shock and at the tail (see airfoil.py).
//
//     meshgrow mesh airfoil.geo -2
//     meshgrow mesh airfoil.geo -2 -setnumber six_fixed 1
//     meshgrow mesh airfoil.geo -2 -setnumber quads 1
//
// First way: three curves, bunched, and one mesh size function. Second way (six_fixed): curves that
// are split where sizes shall be, and six fixed size functions.

DefineConstant[
  six_fixed = {0, Choices{0, 1}, Name "Parameters/Six fixed size functions"},
  quads = {0, Choices{0, 1}, Name "Parameters/Quadrilaterals"},
  growth_rate = {1.2, Min 1.05, Max 2, Name "Parameters/Growth rate"},
  size_limit = {1.0, Min 0.1, Max 2, Name "Parameters/Size limit"}
];
far = 4.0;         // radius of the air around the airfoil, in chords
shock = 0.6;       // where it is on the upper side, in chords from the nose
panel = 0.004;     // between points of the splines
steps = 2000;      // along a curve, to measure it
thickness = 0.12;

// A Call has a line of its own, since Gmsh reads the rest of its line before the macro.

// Where the upper (side = 1) or lower side (-1) is at x of the chord: at x, y.
Macro Place
  half = 5 * thickness * (0.2969 * Sqrt(x) + x * (-0.1260 + x * (
      -0.3516 + x * (0.2843 - x * 0.1036))));
  y = side * half;
Return

// Adds a point at x of a side: `point`.
Macro AddPoint
  Call Place;
  point = newp;
  Point(point) = {x, y, 0};
Return

// Adds the splines of a side between the points `tags` at `ends` of the chord to `curves`. The
// points of a spline are equally far apart, as Gmsh bunches by the parameter of a curve.
Macro AddSide
  For k In {0 : #ends() - 2}
    begin = Acos(1 - 2 * ends(k));
    finish = Acos(1 - 2 * ends(k + 1));
    xs() = {};
    ys() = {};
    walked() = {};
    For i In {0 : steps}
      x = 0.5 * (1 - Cos(begin + i * (finish - begin) / steps));
      Call Place;
      way = 0;
      If (i > 0)
        dx = x - xs(i - 1);
        dy = y - ys(i - 1);
        way = walked(i - 1) + Sqrt(dx * dx + dy * dy);
      EndIf
      xs() += x;
      ys() += y;
      walked() += way;
    EndFor
    count = Ceil(walked(steps) / panel);
    points() = {tags(k)};
    For i In {1 : steps - 1}
      If (walked(i) >= #points() * walked(steps) / count && #points() < count)
        point = newp;
        Point(point) = {xs(i), ys(i), 0};
        points() += point;
      EndIf
    EndFor
    points() += tags(k + 1);
    curve = #curves() + 1;
    Spline(curve) = points();
    curves() += curve;
  EndFor
Return

curves() = {};
If (!six_fixed)
  // The first way, from the nose over the shock to the tail and back below.
  side = 1;
  x = 0.0;
  Call AddPoint;
  nose = point;
  x = 1.0;
  Call AddPoint;
  tail = point;
  x = shock;
  Call AddPoint;
  split = point;
  ends() = {0.0, shock, 1.0};
  tags() = {nose, split, tail};
  Call AddSide;
  side = -1;
  ends() = {1.0, 0.0};
  tags() = {tail, nose};
  Call AddSide;
  Transfinite Curve{1} = 32 Using Bump 0.22;
  Transfinite Curve{2} = 27 Using Bump 0.3;
  Transfinite Curve{3} = 40 Using Bump 0.15;
  DefineConstant[
    airfoil = {Sprintf("mesh source Curve{1:3} attach Surface{1} growth %g limit %g", growth_rate,
                       size_limit), Name "Size functions/airfoil", ReadOnly 1}
  ];
Else
  // The second way: the curves of Figure 1 of the paper, ab (1) to fg (6) and hj (7) to la (10). a
  // is the nose; g and h are one point, as the tail is closed.
  upper() = {0.0, 0.01, 0.04, 0.578, 0.622, 0.98, 1.0};
  lower() = {1.0, 0.98, 0.04, 0.01, 0.0};
  side = 1;
  upper_tags() = {};
  For j In {0 : 6}
    x = upper(j);
    Call AddPoint;
    upper_tags() += point;
  EndFor
  side = -1;
  lower_tags() = {upper_tags(6)};
  For j In {1 : 3}
    x = lower(j);
    Call AddPoint;
    lower_tags() += point;
  EndFor
  lower_tags() += upper_tags(0);
  side = 1;
  ends() = upper();
  tags() = upper_tags();
  Call AddSide;
  side = -1;
  ends() = lower();
  tags() = lower_tags();
  Call AddSide;
  grown = Sprintf("growth %g limit %g", growth_rate, size_limit);
  DefineConstant[
    a = {StrCat("fixed source Point{1} attach Surface{1} size 0.007 ", grown),
         Name "Size functions/a", ReadOnly 1},
    bc = {StrCat("fixed source Curve{2} attach Surface{1} size 0.009 ", grown),
          Name "Size functions/bc", ReadOnly 1},
    de = {StrCat("fixed source Curve{4} attach Surface{1} size 0.0075 ", grown),
          Name "Size functions/de", ReadOnly 1},
    fg = {StrCat("fixed source Curve{6} attach Surface{1} size 0.007 ", grown),
          Name "Size functions/fg", ReadOnly 1},
    hj = {StrCat("fixed source Curve{7} attach Surface{1} size 0.007 ", grown),
          Name "Size functions/hj", ReadOnly 1},
    kl = {StrCat("fixed source Curve{9} attach Surface{1} size 0.009 ", grown),
          Name "Size functions/kl", ReadOnly 1}
  ];
EndIf

// The air: a disk with the airfoil cut out.
center = newp;
Point(center) = {0.5, 0, 0};
Point(center + 1) = {0.5 + far, 0, 0};
Point(center + 2) = {0.5, far, 0};
Point(center + 3) = {0.5 - far, 0, 0};
Point(center + 4) = {0.5, -far, 0};
arc = #curves();
For i In {1 : 4}
  Circle(arc + i) = {center + i, center, center + (i % 4) + 1};
EndFor
Curve Loop(1) = {arc + 1 : arc + 4};
Curve Loop(2) = curves();
Plane Surface(1) = {1, 2};
If (quads)
  Recombine Surface{1};
EndIf
Mesh.Algorithm = 6;
Mesh.MeshSizeMax = size_limit;
