#include <algorithm>

#include "canyon/gnss/satellites/navigation_data.h"

namespace canyon::gnss {
namespace {

class Merged final : public Constellation {
 public:
  explicit Merged(std::vector<std::unique_ptr<Constellation>> parts) : parts_(std::move(parts)) {
    for (std::size_t i = 0; i < parts_.size(); ++i)
      for (const SatelliteId sv : parts_[i]->satellites()) part_of_.emplace(sv, i);
    for (const auto& [sv, part] : part_of_) satellites_.push_back(sv);
  }

  const std::vector<SatelliteId>& satellites() const override { return satellites_; }

  std::optional<SatelliteState> state(SatelliteId sv, GpsTime t) const override {
    const auto part = part_of_.find(sv);
    return part == part_of_.end() ? std::nullopt : parts_[part->second]->state(sv, t);
  }
  std::optional<SatelliteState> state_received(SatelliteId sv, GpsTime t, GpsTime received) const override {
    const auto part = part_of_.find(sv);
    return part == part_of_.end() ? std::nullopt : parts_[part->second]->state_received(sv, t, received);
  }

 private:
  std::vector<std::unique_ptr<Constellation>> parts_;
  std::map<SatelliteId, std::size_t> part_of_;
  std::vector<SatelliteId> satellites_;
};

}  // namespace

std::unique_ptr<Constellation> make_merged(std::vector<std::unique_ptr<Constellation>> parts) {
  return std::make_unique<Merged>(std::move(parts));
}

}  // namespace canyon::gnss
