#include <cstdio>
#include <memory>
#include <vector>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/verb.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"
#include "canyon/inertial/paper_figures.h"
#include "canyon/report/draw/picture.h"

namespace canyon::apps {

namespace {

using inertial::PaperDrift;

struct Options {
  CommonOptions common;
  std::string out;
  std::int64_t seed = 1;
  bool force = false;
};

struct Form {
  const char* chain;
  const char* words;
  const char* file;
};
constexpr Form kForms[] = {{"paper_as_printed", "as printed", "as_printed"}, {"paper", "as corrected", "corrected"}};

std::string csv_of(const PaperDrift& d) {
  std::string out = "t_s,rate_x_deg_s,rate_y_deg_s,rate_z_deg_s,angle_x_deg,angle_y_deg,angle_z_deg,x_m,y_m,z_m\n";
  char row[260];
  for (std::size_t k = 0; k < d.t_s.size(); ++k) {
    std::snprintf(row, sizeof row, "%.3f,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", d.t_s[k], d.rate_deg_s[0][k],
                  d.rate_deg_s[1][k], d.rate_deg_s[2][k], d.angle_deg[0][k], d.angle_deg[1][k], d.angle_deg[2][k],
                  d.position_m[0][k], d.position_m[1][k], d.position_m[2][k]);
    out += row;
  }
  return out;
}

std::string picture_of(const inertial::PaperFigure& figure, const Form& form, const PaperDrift& d) {
  const auto panel = [&](const char* title, const char* unit, const std::array<std::vector<double>, 3>& y) {
    report::Panel out{.title = title, .unit = unit};
    for (std::size_t i = 0; i < 3; ++i)
      out.lines.push_back({.run = i, .name = std::string(1, "xyz"[i]), .x = d.t_s, .y = y[i]});
    return out;
  };
  return report::picture_svg(report::time_picture(
      std::string(figure.doc) + ", " + form.words,
      {panel("Angular rate", "deg/s", d.rate_deg_s), panel("Integral of each gyroscope (heading)", "deg", d.angle_deg),
       panel("Position", "m", d.position_m)}));
}

/// One figure in one of its forms.
struct Drawn {
  const inertial::PaperFigure* figure;
  const Form* form;
  PaperDrift drift;
};

Json json_of(const Drawn& d) {
  Json angles = Json::array(), positions = Json::array(), drifts = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double angle_deg = d.drift.angle_deg[axis].back();
    angles.push_back(angle_deg);
    drifts.push_back(angle_deg / d.figure->seconds * 3600.0);
    positions.push_back(d.drift.position_m[axis].back());
  }
  return {{"figure", d.figure->name},   {"form", d.form->words},     {"duration_s", d.figure->seconds},
          {"drift_deg_per_hr", drifts}, {"final_angle_deg", angles}, {"final_position_m", positions}};
}

Json json_of(const std::vector<Drawn>& all) {
  Json figures = Json::array();
  for (const Drawn& d : all) figures.push_back(json_of(d));
  return {{"figures", figures}};
}

Status write_output(const Options& options, const std::vector<Drawn>& all) {
  CANYON_TRY(auto staged, StagedDirectory::create(options.out, options.force));
  const std::string folder = staged.staging_path() + "/";
  for (const Drawn& d : all) {
    const std::string path = folder + d.figure->name + "_" + d.form->file;
    CANYON_TRY_STATUS(write_text_file(path + ".csv", csv_of(d.drift)));
    CANYON_TRY_STATUS(write_text_file(path + ".svg", picture_of(*d.figure, *d.form, d.drift)));
  }
  CANYON_TRY_STATUS(write_text_file(folder + "summary.json", json_text(json_of(all), 2) + "\n"));
  return staged.commit();
}

void tell(const std::vector<Drawn>& all) {
  for (const Drawn& d : all) {
    if (d.form == &kForms[0]) std::printf("%s: %s\n", d.figure->name, d.figure->doc);
    std::printf("  %-13s", d.form->words);
    for (const auto& angle_deg : d.drift.angle_deg)
      std::printf(" %11.5g", angle_deg.back() / d.figure->seconds * 3600.0);
    std::printf(" deg/h ");
    for (const auto& position_m : d.drift.position_m) std::printf(" %11.5g", position_m.back());
    std::printf(" m\n");
  }
}

Result<int> run(const Options& options) {
  std::vector<Drawn> all;
  for (const inertial::PaperFigure& figure : inertial::paper_figures())
    for (const Form& form : kForms) {
      throw_if_cancelled();
      CANYON_TRY(PaperDrift drift, inertial::paper_drift(figure, form.chain, static_cast<std::uint64_t>(options.seed)));
      all.push_back({&figure, &form, std::move(drift)});
    }
  if (!options.out.empty()) CANYON_TRY_STATUS(write_output(options, all));
  if (options.common.json)
    std::printf("%s\n", json_text(json_of(all)).c_str());
  else
    tell(all);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments.option("--seed", options->seed, "seed of every random stream")
      .default_shown()
      .within(std::int64_t{0}, kLargestSeed);
  arguments.option("--out", options->out, "directory for a CSV and a picture of each, and summary.json");
  arguments.flag("--force", options->force,
                 "replace the directory if it exists; only one that canyon wrote, or an empty one");
  return [options]() -> Result<int> { return run(*options); };
}

}  // namespace

Verb imu_paper_verb() {
  return {"imu paper", "Durst & Goodin's figures 2, 3 and 7, as printed and as corrected",
          "canyon imu paper --out figures", declare};
}

}  // namespace canyon::apps
