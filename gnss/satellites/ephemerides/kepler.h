#pragma once

namespace canyon::gnss {

/// Solves Kepler's equation M = E - e sin E for the eccentric anomaly E, rad.
///
/// Any finite M (whole turns are kept: E and M lie in the same turn) and any e in [0, 1); throws ProgramError outside.
/// Newton's method inside a bracket that always holds the root, so it cannot diverge, however eccentric the orbit; the
/// residual in M is a few units in the last place.
double eccentric_anomaly(double mean_anomaly_rad, double eccentricity);

}  // namespace canyon::gnss
