#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/fusion/consistency.h"
#include "canyon/fusion/verdict/error_record.h"
#include "canyon/fusion/verdict/innovation_record.h"
#include "canyon/fusion/verdict/state_record.h"

namespace canyon::fusion {

/// A mean of squares that is 1 if the filter is right, and the band that it then leaves with the probability of one
/// test's false alarm.
struct SquareMean {
  double value = kNaN;
  double samples = 0.0, effective = 0.0;  ///< vectors; and how many independent ones they are worth
  Band band;
  bool judged() const { return samples > 0.0; }
  /// Outside of the band, and by more than is worth words.
  bool off() const;
  double factor() const;  ///< of sigma: root of value
};

/// Whether a series is white.
struct Whiteness {
  double at_lag_one = kNaN;  ///< normalized autocorrelation
  double statistic = 0.0;    ///< NormalSeries::portmanteau
  double threshold = 0.0;    ///< that it passes with the probability of one test's false alarm
  double correlation_s = 0.0, interval_s = kNaN;
  bool off() const;
};

struct MeasurementNumbers {
  std::string name;
  double count = 0.0, refused = 0.0;
  SquareMean nis = {};  ///< per dimension
  double nis_median_ratio = kNaN;
  Whiteness white = {};
};

struct AxisNumbers {
  std::string block, name, unit;
  double rms = kNaN, claimed = kNaN;  ///< root mean squares of error and sigma
  SquareMean ratio = {};              ///< (error / sigma)^2
};

struct BlockNumbers {
  std::string name;
  SquareMean nees = {};                     ///< per dimension
  double coverage[3] = {kNaN, kNaN, kNaN};  ///< of BlockErrors::kShares
  double correlation_s = 0.0;               ///< of the errors
};

/// Of states of one block with one process: mean of (estimate / the sigma it should have)^2.
struct ProcessNumbers {
  std::string name;
  SquareMean ratio = {};
};

struct FixNumbers {
  double rms_m = kNaN, claimed_m = kNaN;  ///< root mean squares over axes
  SquareMean ratio = {};
  Whiteness white = {};
  bool lasting_is_modelled = false;  ///< the filter has states for what lasts of the fixes' errors
};

struct StateNumbers {
  std::string block, name;
  double share = kNaN, least_share = kNaN;
  std::optional<double> halved_after_s = {};
  std::vector<double> shares = {};  ///< at VerdictNumbers::looked_s
};

/// All that is known of how a filter did, in numbers.
struct VerdictNumbers {
  int tests = 0;
  double false_alarm = 0.0;  ///< of one test
  std::vector<MeasurementNumbers> measurements;
  std::vector<AxisNumbers> axes;
  std::vector<BlockNumbers> blocks;
  std::vector<ProcessNumbers> processes;
  std::optional<FixNumbers> fixes;
  std::vector<StateNumbers> states;
  std::vector<double> looked_s = {};  ///< up to 50 instants since the first look
};

/// The errors of the fixes against the truth, where that is known.
struct FixRecord {
  NormalSeries series{3};  ///< whitened by the covariance that each fix states
  double squares_m2 = 0.0, variances_m2 = 0.0;

  void add(GpsTime t, const Eigen::Vector3d& error_m, const Eigen::Matrix3d& covariance_m2);
};

/// Records of one run; null where there is none of its kind.
struct VerdictEvidence {
  const InnovationRecord* innovations = nullptr;
  const ErrorRecord* errors = nullptr;
  const FixRecord* fixes = nullptr;
  const StateRecord* states = nullptr;
};

/// The probability that a right filter is found fault with, all its tests together. Each has it divided by their number
/// (Bonferroni), which holds however the tests hang together.
inline constexpr double kVerdictFalseAlarm = 0.01;

VerdictNumbers verdict_numbers(const VerdictEvidence& evidence, double false_alarm = kVerdictFalseAlarm);

/// One thing that is to be said.
struct Finding {
  enum class Kind { kErrors, kInnovations, kWhiteness, kRefused, kProcess, kFixes, kNotObserved };
  Kind kind;
  std::string subject;  ///< name in VerdictNumbers
  double badness;       ///< logarithm of a factor on sigma, or what is like it
  std::string text;
};
/// The worst first; what is not observed comes last and is no fault.
std::vector<Finding> findings(const VerdictNumbers& numbers);
/// A line each; "consistent" where there is no fault.
std::vector<std::string> verdict_lines(const VerdictNumbers& numbers);

}  // namespace canyon::fusion
