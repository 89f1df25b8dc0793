#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/imu_noise.h"
#include "core/messages.h"
#include "core/result.h"
#include "inertial/catalogue.h"

namespace canyon::inertial {

/// Turns the increments of an ideal IMU into those of a real one. Every error draws from its own named stream
/// ("imu.gyro.white", "imu.accel.turn_on", ...; entity = axis, index = sample), so switching one off shifts no other
/// draw.
class ErrorChain {
 public:
  virtual ~ErrorChain() = default;
  /// Corrupts sample k. The errors depend on (seed, k) alone, not on which samples were asked for before; samples in
  /// ascending order are the fast case.
  virtual void corrupt(std::int64_t k, ImuSample& sample) = 0;
  /// What a filter should be told of this unit.
  virtual const ImuNoise& noise() const = 0;
};

/// One row of the table of error chains.
struct ErrorChainRow {
  const char* name;
  Result<std::unique_ptr<ErrorChain>> (*make)(const CatalogueEntry& entry, std::uint64_t seed, double rate_hz);
  const char* doc;
};

std::span<const ErrorChainRow> error_chains();
std::vector<std::string> error_chain_names();

/// Makers of the rows, each in the file of its model.
Result<std::unique_ptr<ErrorChain>> make_ideal_chain(const CatalogueEntry& entry, std::uint64_t seed, double rate_hz);
Result<std::unique_ptr<ErrorChain>> make_datasheet_chain(const CatalogueEntry& entry, std::uint64_t seed,
                                                         double rate_hz);
Result<std::unique_ptr<ErrorChain>> make_white_only_chain(const CatalogueEntry& entry, std::uint64_t seed,
                                                          double rate_hz);
Result<std::unique_ptr<ErrorChain>> make_paper_chain(const CatalogueEntry& entry, std::uint64_t seed, double rate_hz);
Result<std::unique_ptr<ErrorChain>> make_paper_as_printed_chain(const CatalogueEntry& entry, std::uint64_t seed,
                                                                double rate_hz);

}  // namespace canyon::inertial
