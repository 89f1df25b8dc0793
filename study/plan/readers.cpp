#include "canyon/study/plan/readers.h"
#include "canyon/lidar/kept_room.h"

#include <algorithm>
#include <cstdio>

namespace canyon::study {

namespace {

Need read_by(const char* effect, const std::string& reader) {
  return {.effect = effect, .verdict = Verdict::kNeeded, .reason = "read by " + reader};
}

Need unread(const char* effect, const char* why) {
  return {.effect = effect, .verdict = Verdict::kNotNeeded, .reason = why};
}

/// "--for map,clouds", of those that read maps; empty: none.
std::string readers_of_maps(const std::vector<Output>& outputs) {
  std::string readers;
  for (const Output output : {Output::kMap, Output::kClouds})
    if (reads(outputs, output)) readers += (readers.empty() ? "--for " : ",") + std::string(name(output));
  return readers;
}

/// A shot whose return whoever takes scans would drop: only of an autonomy is it known what it keeps.
Need ray_need(const mission::MissionConfig& config, const mission::Autonomy& autonomy, bool autonomy_reads,
              bool keyframes) {
  const auto kept = autonomy.keeps();
  if (keyframes) return read_by(kUnkeptRays, "the keyframes, at every range");
  if (!autonomy_reads) return unread(kUnkeptRays, "no scan is read");
  if (!kept) return {.effect = kUnkeptRays, .reason = "the autonomy does not say what it keeps"};
  if (!lidar::follows_shots_alone(config.lidar))
    return {.effect = kUnkeptRays, .reason = "what a shot returns may depend on what lies beyond it"};
  char why[160];
  std::snprintf(why, sizeof why, "the autonomy keeps returns from %g m to %g m over its ground plane, within %.1f m",
                kept->low_m, kept->high_m, kept->half_size_m);
  return unread(kUnkeptRays, why);
}

bool not_needed(const std::vector<Need>& needs, const char* effect) {
  return std::any_of(needs.begin(), needs.end(),
                     [&](const Need& need) { return need.effect == effect && need.verdict == Verdict::kNotNeeded; });
}

}  // namespace

std::vector<Need> reader_needs(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                               const std::vector<Output>& outputs, bool open_loop) {
  std::vector<Need> needs;
  const std::string maps = readers_of_maps(outputs);
  const bool by_autonomy = config.autonomy.map == mission::MapPose::kRegistered;
  const bool registered_poses = mission::takes_registered_poses(config);
  const bool registers = lidar::registers(config.registration);
  const bool aligned = registers && (!maps.empty() || registered_poses);
  if (registers)
    needs.push_back(!maps.empty() ? read_by(kRegistration, maps)
                    : by_autonomy ? read_by(kRegistration, "the autonomy ([autonomy] map = \"registered\")")
                    : registered_poses
                        ? read_by(kRegistration, "the filter ([fusion] map_aiding or map_pose)")
                        : unread(kRegistration, "no output, and neither autonomy nor filter, takes the poses"));
  needs.push_back(maps.empty() ? unread(kMaps, "no output has a map") : read_by(kMaps, maps));
  if (maps.empty() && !aligned)
    needs.push_back(unread(kKeyframes, "nothing is made of them"));
  else
    needs.push_back(read_by(kKeyframes, maps.empty() ? "registration" : maps));

  const auto autonomy = mission::make_autonomy(config.autonomy, mission.prior, mission.start);
  const bool keyframes = !not_needed(needs, kKeyframes);
  const bool drives = !open_loop || reads(outputs, Output::kOutcome);
  const bool looks = drives && autonomy->looks();
  needs.push_back(!open_loop ? read_by(kAutonomy, "the vehicle")
                  : drives   ? read_by(kAutonomy, "--for outcome")
                             : unread(kAutonomy, "the tape drives, and no output has what it asks for"));
  needs.push_back(looks       ? read_by(kScans, "the autonomy, all of them")
                  : keyframes ? read_by(kScans, "the keyframes, where one is due")
                              : unread(kScans, "no autonomy looks, and no keyframe is taken"));
  if (looks || keyframes) needs.push_back(ray_need(config, *autonomy, looks, keyframes));
  needs.push_back(mission.traffic.empty() ? unread(kMovedScene, "nothing moves in the scene")
                                          : read_by(kMovedScene, "LIDAR, GNSS and scorer"));
  return needs;
}

void leave_out_unread(const std::vector<Need>& needs, mission::Omissions& omissions) {
  omissions.registration = omissions.registration || not_needed(needs, kRegistration);
  omissions.maps = omissions.maps || not_needed(needs, kMaps);
  omissions.autonomy = omissions.autonomy || not_needed(needs, kAutonomy);
  omissions.unkept_rays = omissions.unkept_rays || not_needed(needs, kUnkeptRays);
  omissions.keyframes = omissions.keyframes || not_needed(needs, kKeyframes);
}

}  // namespace canyon::study
