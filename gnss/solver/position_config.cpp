#include "canyon/gnss/solver/position_config.h"

#include "canyon/gnss/solver/fault_exclusion.h"

namespace canyon::gnss {

void visit(FieldVisitor& f, PositionConfig& c) {
  visit_choice(f, "solver", c.solver, "how ranges become a position");
  visit_choice(f, "weighting", c.weighting, "1-sigma assumed for each pseudorange");
  f.choice("raim", c.raim, model_names(fault_exclusions()), "test of the ranges against one another, and repair");
  f.number("raim_false_alarm", c.raim_false_alarm, {1e-9, 0.5}, "probability that a faultless epoch fails that test");
  f.number("solver_sigma_m", c.solver_sigma_m, {1e-3, 1000.0},
           "1-sigma the solver assumes for a corrected pseudorange at the zenith");
  f.number("max_gdop", c.max_gdop, {1.0, 1e6}, "fixes with a larger GDOP are refused");
  f.choice("estimator", c.estimator, estimators(),
           "least_squares = each epoch by itself; kalman = position, velocity and time filtered by the receiver, whose "
           "fixes then have errors that last");
  f.number("estimator_acceleration_m_s2", c.estimator_acceleration_m_s2, {1e-6, 1000.0},
           "kalman: white acceleration of the antenna per axis, m/s^2/sqrt(Hz)");
  f.number("smoothing_s", c.smoothing_s, {0.0, 3600.0},
           "time constant of the smoothing of code by carrier phase (Hatch) in the receiver; 0 = off");
  visit_choice(f, "reported_covariance", c.reported_covariance, "the covariance that comes with a fix");
  f.integer("fewest_satellites", c.fewest_satellites, {0, 20},
            "a fix that fewer satellites are used in is not given out; 0 = whatever can be solved");
  f.number("accuracy_limit_m", c.accuracy_limit_m, {0.0, 1e6},
           "a fix whose reported 3-D 1-sigma is larger is not given out; 0 = no limit");
}

PositionSolverParameters PositionConfig::parameters() const {
  PositionSolverParameters p;
  p.max_gdop = max_gdop;
  p.fault_exclusion = raim;
  p.false_alarm = raim_false_alarm;
  return p;
}

}  // namespace canyon::gnss
