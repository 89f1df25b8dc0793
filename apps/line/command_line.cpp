#include "canyon/apps/line/command_line.h"

#include <cstdio>
#include <exception>
#include <map>
#include <new>

#include <CLI/CLI.hpp>

#include "canyon/apps/line/invocation.h"
#include "canyon/apps/line/standard_streams.h"
#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/line/verb.h"
#include "canyon/core/printable_text.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/process/version.h"
#include "canyon/scene/tracing/ray_tracer_instructions.h"

namespace canyon::apps {

namespace {

std::string group_summary(const std::string& group) {
  if (group == "gnss") return "satellites, measurements and positions by themselves";
  if (group == "imu") return "inertial data by itself";
  if (group == "lidar") return "scans, registration and maps by themselves";
  if (group == "scene") return "build, import and inspect a scene";
  return "";
}

int complain(const Error& error) {
  std::fprintf(stderr, "%s\n", error.str().c_str());
  return error.exit_code;
}

int interrupted() {
  tell_interruption();
  return 130;
}

/// The subcommand of a verb, inside its group's if it has one.
CLI::App* declare_verb(CLI::App& app, const Verb& verb) {
  const std::string name = verb.name;
  const std::size_t blank = name.find(' ');
  if (blank == std::string::npos) return app.add_subcommand(name, verb.summary);
  const std::string group_name = name.substr(0, blank);
  CLI::App* group = nullptr;
  for (CLI::App* known : app.get_subcommands([](CLI::App*) { return true; }))
    if (known->get_name() == group_name) group = known;
  if (group == nullptr) {
    group = app.add_subcommand(group_name, group_summary(group_name));
    group->require_subcommand(1);
  }
  return group->add_subcommand(name.substr(blank + 1), verb.summary);
}

/// The subcommand that was asked for, inside its group.
const CLI::App* chosen(const CLI::App& app) {
  const CLI::App* sub = app.get_subcommands().front();
  while (!sub->get_subcommands().empty()) sub = sub->get_subcommands().front();
  return sub;
}

}  // namespace

void declare_common(Arguments& arguments, CommonOptions& options) {
  arguments.option("--threads", options.threads, "threads for everything; 0 = all cores")
      .default_shown()
      .within(0, 1024);
  arguments.flag("--json", options.json, "print one JSON object on stdout and nothing else");
}

void print_warning(const std::string& line) {
  std::fprintf(stderr, "warning: %s\n", escaped_text(line).c_str());
}

void print_warnings(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) print_warning(line);
}

namespace {

/// Parses the arguments and runs the verb.
int parse_and_run(int argc, char** argv) {
  CLI::App app{"Canyon: how much navigation fidelity does an autonomous vehicle's test need, and what does it cost?"};
  app.name("canyon");
  app.set_version_flag("--version", std::string("canyon ") + kVersion);
  app.require_subcommand(1);
  app.footer("\nExample, the same mission at three fidelities side by side:\n  canyon compare --out first");
  std::map<const CLI::App*, VerbAction> actions;
  for (const Verb& verb : {compare_verb(),
                           run_verb(),
                           plan_verb(),
                           tradeoff_verb(),
                           stress_verb(),
                           reproduce_verb(),
                           tolerance_verb(),
                           report_verb(),
                           keys_verb(),
                           gnss_sky_verb(),
                           gnss_simulate_verb(),
                           gnss_solve_verb(),
                           gnss_orbit_error_verb(),
                           gnss_map_verb(),
                           gnss_drive_check_verb(),
                           imu_allan_verb(),
                           imu_fit_verb(),
                           imu_simulate_verb(),
                           imu_dead_reckon_verb(),
                           lidar_scan_verb(),
                           scene_make_verb(),
                           scene_info_verb(),
                           fuse_verb(),
                           lidar_register_verb(),
                           lidar_evaluate_verb(),
                           lidar_error_budget_verb(),
                           lidar_close_loops_verb(),
                           lidar_error_events_verb(),
                           lidar_error_response_verb()}) {
    CLI::App* sub = declare_verb(app, verb);
    sub->footer(std::string("\nExample:\n  ") + verb.example);
    Arguments arguments(*sub);
    actions[sub] = verb.declare(arguments);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return complain(usage_error(app, error, {argv + 1, argv + argc}));
  }

  if (const auto limit = scene::check_ray_tracer_limit(); !limit.ok()) return complain(limit.error());
  try {
    const auto result = actions.at(chosen(app))();
    if (result) return *result;
    // What cannot be read or written any more because of the interruption is no mistake.
    return cancel_requested() ? interrupted() : complain(result.error());
  } catch (const Cancelled&) {
    return interrupted();
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "canyon could not finish: there is not enough memory\n");
    return 1;
  } catch (const std::exception& error) {
    if (cancel_requested()) return interrupted();
    std::fprintf(stderr, "canyon could not finish: %s\n", error.what());
    return 1;
  }
}

}  // namespace

int run_command_line(int argc, char** argv, const char* commit) {
  prepare_standard_streams();
  install_cancel_handler();
  set_invocation(argc, argv, commit);
  int status = parse_and_run(argc, argv);
  if (const auto printed = finish_standard_output(); !printed.ok() && status != 130) status = complain(printed.error());
  remove_cancel_handler();
  return status;
}

}  // namespace canyon::apps
