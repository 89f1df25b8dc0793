#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace canyon::testing {

struct SyntheticOptions {
  double speed_m_s = 4.0;
  double gnss_rate_hz = 2.0;
  bool paper = true;
  bool mixed = true;  ///< the two mixed runs and the 2 x 2
  bool clouds = true;
  int cloud_points_per_keyframe = 120;
};

/// Writes a plausible results directory, made up but consistent, exactly as docs/results.md says; `directory` must
/// exist and be empty. Run `low` succeeds and has no satellites; run `high` meets multipath and poor geometry in the
/// deep quarter and collides there.
void write_synthetic_results(const std::string& directory, const SyntheticOptions& options = {});

/// summary.json of such a directory, read, changed by `change`, and written back.
template <class Change>
void edit_json(const std::string& file, Change change);

nlohmann::ordered_json load_json(const std::string& file);
void store(const std::string& file, const std::string& text);
std::string load(const std::string& file);

template <class Change>
void edit_json(const std::string& file, Change change) {
  nlohmann::ordered_json json = load_json(file);
  change(json);
  store(file, json.dump(1));
}

}  // namespace canyon::testing
