#pragma once

#include <memory>

#include "canyon/study/tradeoff/measuring/repetitions.h"
#include "canyon/study/tradeoff/result.h"

namespace canyon::study {

/// What a ladder is measured with beside its rungs.
struct Measuring {
  const mission::PreparedMission& mission;
  const Tape& tape;
  std::size_t samples = 60;
  int repetitions = 5;
  std::uint64_t seed = 1;
  const RecordedDrive* recording = nullptr;
};

/// Makes the rungs' probes, repeats them and says what each errs and costs. Rungs that cannot be made join
/// `left_out`. An Error if the reference is one of them.
Result<MeasuredLadder> measure(const RungList& rungs, const Measuring& with);

/// The same of probes that are there already, of which `names` are the rungs' names. `reference`: none = truth.
struct Contenders {
  std::vector<std::string> names;
  std::vector<std::optional<double>> values;
  std::vector<std::unique_ptr<Probe>> probes;
  std::optional<std::size_t> reference;
  bool reference_is_rung = true;
  std::vector<std::string> series;  ///< rungs without steps, coarse to fine
  double rounding = 0.0;
};
Status measure(const Contenders& contenders, int repetitions, std::uint64_t seed, MeasuredLadder& out);

}  // namespace canyon::study
