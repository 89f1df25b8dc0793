#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "canyon/gnss/satellites/constellation.h"

namespace canyon::gnss {

/// A constellation that counts what it is asked.
class CountedSky final : public Constellation {
 public:
  explicit CountedSky(std::unique_ptr<Constellation> sky) : sky_(std::move(sky)) {}
  const std::vector<SatelliteId>& satellites() const override { return sky_->satellites(); }
  std::optional<SatelliteState> state(SatelliteId sv, GpsTime t) const override {
    ++asked;
    return sky_->state(sv, t);
  }
  mutable int asked = 0;

 private:
  std::unique_ptr<Constellation> sky_;
};

}  // namespace canyon::gnss
