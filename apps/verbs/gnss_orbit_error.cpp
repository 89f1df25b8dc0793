#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/verb.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/gnss/orbit_error.h"
#include "canyon/gnss/products/precise_products.h"
#include "canyon/gnss/rinex/navigation/navigation_file.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> nav, sp3;
  std::string clk, antex = "none", systems = "GRECJ", choice = "nearest", out;
  bool force = false;
};

void tell_warnings(const gnss::NavigationData& nav, const gnss::PreciseProducts& precise) {
  print_warnings(nav.warnings);
  if (const std::string skipped = nav.skipped(); !skipped.empty())
    print_warning(nav.names() + ": records that are not used: " + skipped);
  print_warnings(precise.warnings());
}

Json json_of(const gnss::OrbitErrorFigures& f) {
  return {{"radial_rms_m", or_null(f.radial_rms_m)},
          {"along_rms_m", or_null(f.along_rms_m)},
          {"cross_rms_m", or_null(f.cross_rms_m)},
          {"rms_3d_m", or_null(f.rms_3d_m)},
          {"sisre_m", or_null(f.sisre_m)},
          {"satellites", f.satellites},
          {"samples", f.samples},
          {"radial_mean_m", or_null(f.radial_mean_m)},
          {"clock_rms_m", or_null(f.clock_rms_m)},
          {"sisre_unbiased_m", or_null(f.sisre_unbiased_m)},
          {"sisre_receiver_m", or_null(f.sisre_receiver_m)}};
}

void print_row(const std::string& name, const gnss::OrbitErrorFigures& f) {
  std::printf("  %-8s %4d %7d  %7.3f %7.3f %7.3f %7.3f %7.3f %7.3f %7.3f %8.3f %8.3f\n", name.c_str(), f.satellites,
              f.samples, f.radial_mean_m, f.radial_rms_m, f.along_rms_m, f.cross_rms_m, f.rms_3d_m, f.clock_rms_m,
              f.sisre_m, f.sisre_unbiased_m, f.sisre_receiver_m);
}

void print_json(const gnss::OrbitErrors& errors) {
  Json out = json_of(errors.figures());
  out["without_clock"] = errors.without_clock;
  out["by_system"] = Json::object();
  out["by_satellite"] = Json::object();
  for (const auto& [letter, known] : errors.satellites()) {
    out["by_system"][std::string(1, letter)] = json_of(errors.of_system(letter));
    for (const SatelliteId sv : known) out["by_satellite"][sv.str()] = json_of(errors.of_satellite(sv));
  }
  std::printf("%s\n", json_text(out).c_str());
}

void print_text(const gnss::OrbitErrors& errors, const Options& options) {
  const auto& samples = errors.samples;
  std::printf("Broadcast minus precise, %s to %s GPS time; antennas: %s\n\n", samples.front().t.iso(0).c_str(),
              samples.back().t.iso(0).c_str(), options.antex.c_str());
  std::printf("                           radial  radial   along   cross     3-D   clock   SISRE    SISRE    SISRE\n");
  std::printf("           sats samples      mean     RMS     RMS     RMS     RMS     RMS          unbiased receiver\n");
  std::printf("                                m       m       m       m       m       m       m        m        m\n");
  const auto by_system = errors.satellites();
  for (const auto& [letter, known] : by_system) {
    for (const SatelliteId sv : known) print_row(sv.str(), errors.of_satellite(sv));
    print_row(std::string("all ") + letter, errors.of_system(letter));
  }
  if (by_system.size() > 1) print_row("all", errors.figures());
  if (errors.without_clock > 0)
    std::printf("\n%d precise positions without a known clock were left out\n", errors.without_clock);
  if (options.antex == "none")
    std::printf(
        "\nWithout --antex the precise positions are centres of mass and the broadcast ones antennas: "
        "the radial mean shows the offset between them.\n");
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  CANYON_TRY_STATUS(gnss::check_systems(options.systems, "--systems"));
  CANYON_TRY(const auto nav, gnss::read_navigation_files(options.nav));
  CANYON_TRY(const auto precise,
             gnss::read_precise_products(options.sp3, options.clk, options.antex == "none" ? "" : options.antex));
  const gnss::BroadcastOptions broadcast{
      .systems = options.systems,
      .choice = options.choice == "nearest" ? gnss::EphemerisChoice::kNearestToe : gnss::EphemerisChoice::kTransmitted};
  const gnss::OrbitErrors errors =
      orbit_errors(*make_broadcast(nav, broadcast), precise.orbits, precise.options(options.systems));
  tell_warnings(nav, precise);
  if (errors.samples.empty())
    return Error{nav.names(), 0, "", "no satellite has a broadcast ephemeris at an epoch of " + precise.orbits.names(),
                 "files of the same day"};
  if (!options.out.empty()) {
    CANYON_TRY(auto staged, StagedDirectory::create(options.out, options.force));
    CANYON_TRY_STATUS(write_text_file(staged.staging_path() + "/orbit_error.csv", gnss::orbit_error_csv(errors)));
    CANYON_TRY_STATUS(staged.commit());
  }
  if (options.common.json)
    print_json(errors);
  else
    print_text(errors, options);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments.option("--nav", options->nav, "RINEX navigation files").required();
  arguments.option("--sp3", options->sp3, "SP3 files of the same days").required();
  arguments.option("--clk", options->clk, "RINEX clock file, instead of the clocks of the SP3 files");
  arguments.option("--antex", options->antex, "ANTEX file: satellite antenna offsets; none = leave them in")
      .default_shown();
  arguments.option("--systems", options->systems, "satellite systems, letters of GRECJ").default_shown();
  arguments
      .option("--ephemeris", options->choice,
              "record used: nearest (reference time nearest to the epoch) or transmitted (newest sent by then)")
      .among({"nearest", "transmitted"})
      .default_shown();
  arguments.option("--out", options->out, "directory for orbit_error.csv, every satellite and epoch");
  arguments.flag("--force", options->force, "replace an existing --out");
  return [options]() -> Result<int> { return run(*options); };
}

}  // namespace

Verb gnss_orbit_error_verb() {
  return {"gnss orbit-error", "broadcast orbits and clocks against precise ones",
          "canyon gnss orbit-error --nav brdc1820.10n --sp3 igs15904.sp3", declare};
}

}  // namespace canyon::apps
