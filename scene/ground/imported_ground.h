#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "canyon/core/process/progress.h"
#include "canyon/scene/file_frame.h"
#include "canyon/scene/ground/ground_plan.h"
#include "canyon/scene/import.h"

namespace canyon::scene {

/// The ground under a scene from files: of an elevation model, of the files' own surfaces, or fitted to the heights
/// that they tell at buildings; level where they tell none. In full detail where something stands.
class ImportedGround {
 public:
  /// `config` and `at` must outlive this.
  ImportedGround(const ImportConfig& config, const FileFrame& at, std::int64_t max_triangles)
      : config_(config), at_(at), max_triangles_(max_triangles) {}

  /// Of scenes in W, added to `out`. A scene that is going to have more than max_triangles is refused before the ground
  /// is made; from then on, as long as this lives, progress says how large it is.
  Status make(const std::vector<RawScene>& scenes, ImportedScene& out);

 private:
  Status expect(const std::vector<RawScene>& scenes, double terrain_triangles, ImportReport& report);
  Status make_of_model(const std::vector<RawScene>& scenes, const GroundWish& wish, ImportedScene& out);
  Status make_of_heights(const std::vector<RawScene>& scenes, const GroundWish& wish, ImportedScene& out);

  const ImportConfig& config_;
  const FileFrame& at_;
  std::int64_t max_triangles_;
  std::optional<Progress> progress_;
};

}  // namespace canyon::scene
