#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace canyon::lidar {

/// A point of a map cloud, in W.
struct MapPoint {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();
  float intensity = 0;
};

/// A growing cloud of millions of points: in blocks, so that none is copied while it grows, and what is let go goes
/// back to the system.
class MapCloud {
 public:
  static constexpr std::size_t kBlock = 128 * 1024;  ///< points; the last block may hold fewer

  MapCloud() = default;
  explicit MapCloud(std::span<const MapPoint> points) {
    for (const MapPoint& point : points) push_back(point);
  }

  void push_back(const MapPoint& point) {
    if (size_ % kBlock == 0) blocks_.push_back(std::make_unique_for_overwrite<MapPoint[]>(kBlock));
    blocks_.back()[size_++ % kBlock] = point;
  }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// i < size().
  MapPoint& operator[](std::size_t i) { return blocks_[i / kBlock][i % kBlock]; }
  const MapPoint& operator[](std::size_t i) const { return blocks_[i / kBlock][i % kBlock]; }

  std::size_t blocks() const { return blocks_.size(); }
  /// k < blocks().
  std::span<MapPoint> block(std::size_t k) { return {blocks_[k].get(), size_of(k)}; }
  std::span<const MapPoint> block(std::size_t k) const { return {blocks_[k].get(), size_of(k)}; }

 private:
  std::size_t size_of(std::size_t k) const { return std::min(kBlock, size_ - k * kBlock); }

  std::vector<std::unique_ptr<MapPoint[]>> blocks_;
  std::size_t size_ = 0;
};

}  // namespace canyon::lidar
