#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/inertial/errors/error_link.h"

/// A link of the error chain by itself, and what it makes of samples.
namespace canyon::inertial::made {

inline constexpr double kStep_s = 0.02;
inline constexpr auto kBlock = static_cast<std::int64_t>(kImuBlock);

/// Increments of both triads, gyroscope first.
using Increments = std::array<Eigen::Vector3d, 2>;

inline std::unique_ptr<ErrorLink> link_of(const std::string& name, const LinkSetup& setup) {
  return model_row(error_links(), name).make(setup);
}

/// What the link makes of these samples, as a chain hands them over: never over the border of a block.
inline std::vector<Increments> through(ErrorLink& link, std::int64_t first, const std::vector<Increments>& in,
                                       std::vector<ImuSample>* samples = nullptr) {
  std::vector<Increments> out;
  std::vector<ImuSample> stamped(in.size());
  for (std::size_t i = 0; i < in.size(); ++i) {
    stamped[i].t = tick({}, first + static_cast<std::int64_t>(i) + 1, 1.0 / kStep_s);
    stamped[i].dt_s = kStep_s;
  }
  const auto block = std::make_unique<ImuBlock>();
  for (std::size_t begin = 0; begin < in.size(); begin += block->count) {
    block->first = first + static_cast<std::int64_t>(begin);
    block->count = std::min(in.size() - begin, static_cast<std::size_t>(kBlock - block->first % kBlock));
    block->samples = std::span(stamped).subspan(begin, block->count);
    for (std::size_t i = 0; i < block->count; ++i)
      for (std::size_t t = 0; t < 2; ++t)
        for (std::size_t axis = 0; axis < 3; ++axis)
          block->triads[t].truth[axis][i] = block->triads[t].output[axis][i] =
              in[begin + i][t][static_cast<Eigen::Index>(axis)];
    link.apply(*block);
    for (std::size_t i = 0; i < block->count; ++i) {
      Increments x;
      for (std::size_t t = 0; t < 2; ++t)
        for (std::size_t axis = 0; axis < 3; ++axis)
          x[t][static_cast<Eigen::Index>(axis)] = block->triads[t].output[axis][i];
      out.push_back(x);
    }
  }
  if (samples != nullptr) *samples = stamped;
  return out;
}

/// What it adds.
inline std::vector<Increments> added(ErrorLink& link, std::int64_t first, const std::vector<Increments>& in) {
  auto out = through(link, first, in);
  for (std::size_t i = 0; i < in.size(); ++i)
    for (std::size_t t = 0; t < 2; ++t) out[i][t] -= in[i][t];
  return out;
}

inline std::vector<Increments> still(std::size_t count) {
  return std::vector<Increments>(count, Increments{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
}

}  // namespace canyon::inertial::made
