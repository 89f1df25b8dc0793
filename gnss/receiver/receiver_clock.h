#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "canyon/core/model_choice.h"

namespace canyon::gnss {

/// Receiver clock minus GPS time, as length.
class ReceiverClock {
 public:
  virtual ~ReceiverClock() = default;
  /// At epoch `index` >= 0 of the receiver. A function of (seed, index): not of the calls before. Not thread-safe.
  virtual double offset_m(std::int64_t index) = 0;
  /// Its rate there, m/s.
  virtual double rate_m_s(std::int64_t index) = 0;
  /// True if it is GPS time, so that a solver needs no unknown for it.
  virtual bool perfect() const { return false; }
};

struct ReceiverClockParameters {
  std::uint64_t seed = 0;
  double interval_s = 1.0;  ///< between epochs
};

using MakeReceiverClock = std::unique_ptr<ReceiverClock>(const ModelParameters& own, const ReceiverClockParameters& at);
ModelTable<MakeReceiverClock> receiver_clock_models();

/// Two-state clock (bias and frequency, both with white noise; Brown & Hwang 1997, section 10) of a
/// temperature-compensated crystal, h0 = 2e-19 s, h-2 = 2e-20 1/s; starts within about 1 microsecond and 0.1 ppm
/// (1-sigma) of GPS time.
std::unique_ptr<ReceiverClock> make_tcxo(const ReceiverClockParameters& p);

}  // namespace canyon::gnss
