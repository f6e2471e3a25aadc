#ifndef MESHGROW_GROWTH_LAW_H
#define MESHGROW_GROWTH_LAW_H

namespace meshgrow {

/// How element size grows with the distance from a source (paper, section 4.1; DESIGN.md, section
/// 2).
///
/// With R_0 = 0, R_n = S0 (g + g² + … + gⁿ) and S_n = S0 gⁿ, linear in between, the whole law is
/// one straight line: S(R) = S0 + α R with the slope α = 1 − 1/g.
///
/// All functions are pure and may be called from any thread.

/// Slope α = 1 − 1/g of the law, in [0, 1), for a growth rate g ≥ 1.
double growth_slope(double growth_rate);

/// Size at distance R ≥ 0 (model units) from a facet of start size S0 > 0 (model units): S0 + α R.
double grown_size(double start_size, double growth_rate, double distance);

}  // namespace meshgrow

#endif
