#include "canyon/lidar/beam/echoes.h"

#include <algorithm>
#include <utility>

namespace canyon::lidar {

std::span<EchoPacket> Echoes::start(std::size_t packets) {
  if (packets_.empty()) packets_.emplace_back();
  packets_.front().resize(packets);
  packets_per_layer_ = packets;
  layers_ = 1;
  return layer(0);
}

void Echoes::insert(std::size_t shot, const Echo& echo) {
  const std::size_t packet = shot / EchoPacket::kShots, lane = shot % EchoPacket::kShots;
  Echo moving = echo;
  bool shifting = false;  // those behind the new one move back by one layer, each
  for (std::size_t k = 0; k < kMost && moving.any(); ++k) {
    if (k == layers_) {
      if (packets_.size() == layers_) packets_.emplace_back();
      packets_[layers_].resize(packets_per_layer_);
      ++layers_;
      for (EchoPacket& fresh : layer(k))
        for (std::size_t i = 0; i < EchoPacket::kShots; ++i) fresh.set(i, {});
    }
    EchoPacket& here = packets_[k][packet];
    shifting = shifting || moving.truth.range_m < here.range_m[lane];
    if (!shifting) continue;
    const Echo pushed = here.at(lane);
    here.set(lane, moving);
    moving = pushed;
  }
}

}  // namespace canyon::lidar
