#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "canyon/gnss/paths/counters.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {

/// A corner of a lattice of places or of directions, and what is known there of numbered points. Sight is sharp there:
/// one ray, which is fired when it is first asked for and remembered.
class SightNode {
 public:
  /// Whether point `id` is seen; `blocked()` fires the ray.
  template <class Blocked>
  bool seen(std::uint32_t id, GnssCounters& counters, const Blocked& blocked) {
    Page& page = page_of(id / kPoints);
    const std::size_t word = id % kPoints / 64;
    const std::uint64_t bit = std::uint64_t{1} << (id % 64);
    if ((page.known[word] & bit) == 0) {
      ++counters.occlusion_rays;
      page.known[word] |= bit;
      if (!blocked()) page.seen[word] |= bit;
    }
    return (page.seen[word] & bit) != 0;
  }
  /// A number that hangs on point and node, remembered likewise.
  template <class Make>
  float number(std::uint32_t id, const Make& make) {
    const auto [at, is_new] = numbers_.try_emplace(id, 0.0F);
    if (is_new) at->second = make();
    return at->second;
  }
  std::size_t bytes() const { return sizeof(Page) * pages_.size() + 16 * numbers_.size(); }

 private:
  /// Of points that follow one another. Those near a node are a few runs of a scene's, however many it has.
  static constexpr std::uint32_t kPoints = 512;
  struct Page {
    std::uint32_t number;
    std::array<std::uint64_t, kPoints / 64> known{}, seen{};
  };

  Page& page_of(std::uint32_t number) {
    if (last_ < pages_.size() && pages_[last_].number == number) return pages_[last_];
    for (last_ = 0; last_ < pages_.size(); ++last_)
      if (pages_[last_].number == number) return pages_[last_];
    pages_.push_back({.number = number});
    return pages_.back();
  }

  std::vector<Page> pages_;
  std::size_t last_ = 0;
  std::unordered_map<std::uint32_t, float> numbers_;
};

/// How far fixed, numbered points of a scene are in sight, as a share that changes evenly with place and direction:
/// sight is sharp at the nodes of a lattice, and between them the nodes count in shares of the place. So nothing comes
/// or goes at once, a shadow's border is as wide as a cell, and since rays belong to nodes few are fired where an
/// antenna moves little from epoch to epoch. What is remembered changes no number. Of the scene as it stands: what
/// moves hides no point. Nodes within a solid see nothing. Not for several threads at once (SightPool).
class PointSight {
 public:
  explicit PointSight(const scene::Scene& scene) : scene_(scene) {}

  static constexpr double kCell_m = 2.0;     ///< lattice of places
  static constexpr double kCell_rad = 0.02;  ///< lattice of directions, on a plane by their angle from the zenith

  /// The nodes about a place. Of use until the next call of from().
  class From {
   public:
    /// Of the points' own place q, 0 to 1.
    double share(std::uint32_t id, const Eigen::Vector3d& q_W, GnssCounters& counters) const;

   private:
    friend class PointSight;
    struct Corner {
      Eigen::Vector3d p_W;
      double weight;
      SightNode* node;
    };
    const scene::SceneAt* scene_ = nullptr;
    std::array<Corner, 8> corners_;
  };
  From from(const Eigen::Vector3d& p_W);

  /// The nodes about a direction, up to 90 degrees and a cell from the zenith. Of use until the next call of towards().
  class Towards {
   public:
    struct Corner {
      Eigen::Vector3d s_W;  ///< unit
      double weight;
      SightNode* node;
    };
    bool lit(const Corner& corner, std::uint32_t id, const Eigen::Vector3d& q_W, GnssCounters& counters) const {
      return corner.node->seen(id, counters, [&] { return scene_->blocked_towards(q_W, corner.s_W); });
    }
    double share(std::uint32_t id, const Eigen::Vector3d& q_W, GnssCounters& counters) const {
      double sum = 0.0;
      for (const Corner& corner : corners_)
        if (corner.weight > 0.0 && lit(corner, id, q_W, counters)) sum += corner.weight;
      return sum;
    }
    const std::array<Corner, 4>& corners() const { return corners_; }

   private:
    friend class PointSight;
    const scene::SceneAt* scene_ = nullptr;
    std::array<Corner, 4> corners_;
  };
  Towards towards(const Eigen::Vector3d& s_W);

 private:
  class Nodes {
   public:
    SightNode* at(std::uint64_t key);
    /// Before nodes are asked for: forgets all if they have become too many.
    void make_room();

   private:
    std::unordered_map<std::uint64_t, SightNode> nodes_;
    std::size_t largest_bytes_ = 0;
  };

  scene::SceneAt scene_;
  Nodes places_, directions_;
};

/// Lends a PointSight to each thread that asks, so that none waits for another's rays.
class SightPool {
 public:
  class Loan {
   public:
    Loan(SightPool& pool, std::unique_ptr<PointSight> sight) : pool_(pool), sight_(std::move(sight)) {}
    ~Loan() { pool_.give_back(std::move(sight_)); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    PointSight& operator*() const { return *sight_; }

   private:
    SightPool& pool_;
    std::unique_ptr<PointSight> sight_;
  };
  /// Of that scene; what was remembered of another is forgotten.
  Loan borrow(const scene::Scene& scene);

 private:
  void give_back(std::unique_ptr<PointSight> sight);

  std::mutex mutex_;
  const scene::Scene* scene_ = nullptr;
  std::vector<std::unique_ptr<PointSight>> idle_;
};

}  // namespace canyon::gnss
