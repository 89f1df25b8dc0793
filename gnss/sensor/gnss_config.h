#pragma once

#include "canyon/core/model_choice.h"
#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/errors/ephemeris_error.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/gnss/receiver/code_tracking.h"
#include "canyon/gnss/receiver/link_budget.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"
#include "canyon/gnss/receiver/multipath_rule.h"
#include "canyon/gnss/receiver/receiver_clock.h"
#include "canyon/gnss/receiver/reports/cn0_estimator.h"
#include "canyon/gnss/receiver/signal_lock.h"
#include "canyon/gnss/sensor/satellite_source.h"
#include "canyon/gnss/sensor/sensor_models.h"
#include "canyon/gnss/solver/position_config.h"

namespace canyon::gnss {

/// [gnss] of a mission file: the sensor as a whole, then what a sensor of pseudoranges is made of. Every part's keys
/// stand in the part's own file; in the mission file they are all keys of this one section.
struct GnssConfig {
  ModelChoice<sensor_models> model{"pseudorange"};  ///< truth_plus_isotropic is the paper's low fidelity
  std::string receiver;  ///< entry of gnss/receivers whose figures lie below this section's own keys; "": none
  double rate_hz = 2.0;
  double mask_deg = 10.0;
  Eigen::Vector3d lever_arm_m{-0.3, 0.0, 1.2};  ///< antenna in B

  // What acts on the range, and what the receiver corrects.
  ModelChoice<receiver_modes> mode{"dgps"};
  ModelChoice<ionosphere_models> ionosphere{"single_layer"};
  ModelChoice<troposphere_models> troposphere{"saastamoinen_niell"};
  ModelChoice<ephemeris_error_models> ephemeris_error{"gauss_markov"};
  ModelChoice<receiver_clock_models> receiver_clock{"tcxo"};

  PropagationConfig propagation;
  ReceptionConfig reception;
  LinkConfig link;
  TrackingConfig tracking;
  LockConfig locks;
  Cn0ReportConfig cn0_report;
  PositionConfig position;
  SatelliteSourceConfig satellites;
};
void visit(FieldVisitor& f, GnssConfig& c);

}  // namespace canyon::gnss
