#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/study/plan/plan.h"

namespace canyon::study {

/// How a plan is verified.
enum class Verified {
  kPlaces,     ///< what cannot act: epochs of the GNSS sensor by themselves
  kRanges,     ///< what acts by less: the same epochs
  kEstimates,  ///< the same: rows of whole runs
  kReaders     ///< what nobody reads: rows of runs on pieces of the tape
};
const char* name(Verified kind);

/// What was found of one effect that a plan leaves out.
struct VerifiedEffect {
  std::string effect{};
  Verified kind = Verified::kPlaces;
  std::int64_t replayed = 0;    ///< epochs or rows that were looked at
  std::int64_t epochs = 0;      ///< of those, at which it was left out and compared
  std::int64_t violations = 0;  ///< of those, with a difference beyond the bound
  std::string unit{};           ///< of bound and difference
  bool of_position = false;     ///< what the effect does to fixes and estimates, beside what it does in its own unit
  double bound = 0.0;           ///< the largest that was promised at one of them
  double largest_difference = 0.0;
};

struct Verification {
  std::vector<VerifiedEffect> effects;
  /// Compared with something left out: each counts once, however many effects were left out at it.
  std::int64_t epochs(Verified kind) const;
  std::int64_t epochs() const;  ///< of all kinds; those of kPlaces and kRanges are the same epochs
  std::int64_t violations() const;
  /// Median over effects with a bound above 0 of bound / largest difference, in their own units; NaN where there is
  /// none.
  double tightness() const { return tightness(false); }
  /// The same of what they do to position.
  double position_tightness() const { return tightness(true); }

 private:
  double tightness(bool of_position) const;
};

/// Replays the tape with and without each omission and counts every difference beyond its bound:
/// - what cannot act: `epochs` epochs of the GNSS sensor, anywhere in the corridor at any time
///   (study/plan/replay/replay.h), without each effect by itself and without all of them;
/// - what acts by less than a tolerance: the same epochs, each range in its own unit and each fix, and whole runs on
/// the
///   tape, each estimate of position (study/plan/verify_ranges.h);
/// - what nobody reads: runs on pieces spread over the tape (on all of it, if that many rows are asked for), each of a
///   seed of its own from the mission's on, until `epochs` rows are compared.
Result<Verification> verify_plan(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                 const Tape& tape, const Plan& plan, std::int64_t epochs);

}  // namespace canyon::study
