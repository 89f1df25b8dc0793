#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "canyon/core/imu_noise.h"
#include "canyon/core/messages.h"
#include "canyon/core/model_table.h"
#include "canyon/core/result.h"
#include "canyon/inertial/catalogue.h"
#include "canyon/inertial/environment.h"

namespace canyon::inertial {

/// Turns the increments of an ideal IMU into those of a real one. Every error draws from its own named stream
/// ("imu.gyro.white", "imu.accel.turn_on", ...; entity = axis, index = sample), so switching one off shifts no other
/// draw.
class ErrorChain {
 public:
  virtual ~ErrorChain() = default;
  /// Corrupts sample k. The errors depend on (seed, k) and the motion alone, that of the memory() samples before
  /// included; which samples were asked for before matters only where that motion was not among them: it is then taken
  /// to have been the present one. Samples in ascending order are the fast case.
  virtual void corrupt(std::int64_t k, ImuSample& sample) = 0;
  /// Corrupts samples first, first + 1, ...: the same bits as one by one, several times faster.
  virtual void corrupt_batch(std::int64_t first, std::span<ImuSample> samples) {
    for (ImuSample& sample : samples) corrupt(first++, sample);
  }
  /// So many samples before the first one wanted must be corrupted first (and thrown away) for a part of a run to equal
  /// that part of the whole run: latency and losses look back at earlier motion, 0 for all other links; proof masses
  /// remember it until it is below 1e-16, and then parts agree to rounding.
  virtual std::int64_t memory() const { return 0; }
  /// What a filter should be told of this unit.
  virtual const ImuNoise& noise() const = 0;
};

/// What a chain is made from.
struct ChainSetup {
  CatalogueEntry entry;
  std::uint64_t seed = 0;
  double rate_hz = 100.0;
  std::vector<std::string> leave_out{};  ///< names of links (inertial/errors/error_link.h)
  Environment environment{};
  std::optional<std::uint64_t> noise_seed{};  ///< of the white noise; none: `seed`
};

struct ErrorChainModel {
  Result<std::unique_ptr<ErrorChain>> (*make)(const ChainSetup& setup);
  bool has_links;  ///< made of the links of inertial/errors, any of which can be left out
};
ModelTable<ErrorChainModel> error_chains();

/// The chain of that name. Errors: an unknown name; a link to leave out that the chain does not have; what the row's
/// maker refuses.
Result<std::unique_ptr<ErrorChain>> make_error_chain(const std::string& name, const ChainSetup& setup);

/// Makers of the rows, each in the file of its model.
Result<std::unique_ptr<ErrorChain>> make_ideal_chain(const ChainSetup& setup);
Result<std::unique_ptr<ErrorChain>> make_datasheet_chain(const ChainSetup& setup);
Result<std::unique_ptr<ErrorChain>> make_white_only_chain(const ChainSetup& setup);
Result<std::unique_ptr<ErrorChain>> make_full_chain(const ChainSetup& setup);
Result<std::unique_ptr<ErrorChain>> make_physics_chain(const ChainSetup& setup);
Result<std::unique_ptr<ErrorChain>> make_paper_chain(const ChainSetup& setup);
Result<std::unique_ptr<ErrorChain>> make_paper_as_printed_chain(const ChainSetup& setup);

}  // namespace canyon::inertial
