#include "canyon/mission/scoring/told_failure.h"

namespace canyon::mission {
namespace {

std::string word_of(scene::ObjectKind kind, bool moving) {
  using scene::ObjectKind;
  switch (kind) {
    case ObjectKind::kTerrain:
      return "terrain";
    case ObjectKind::kBuilding:
      return "building";
    case ObjectKind::kVehicle:
      return moving ? "other vehicle" : "vehicle";
    case ObjectKind::kTree:
      return "tree";
    case ObjectKind::kWall:
      return "wall";
    case ObjectKind::kPole:
      return "pole";
    case ObjectKind::kPerson:
      return "person";
    case ObjectKind::kOther:
      return {};
  }
  return {};
}

}  // namespace

ToldFailure told_failure(const Failure& failure) {
  ToldFailure told{.kind = name(failure.kind), .detail = failure.detail};
  if (failure.kind != Outcome::kCollision) return told;
  told.in_scans_s = failure.seen ? failure.seen->stood_s : 0.0;
  if (!failure.seen) return told;
  told.last_range_m = failure.seen->range_m;
  told.last_seen_s = failure.seen->ago_s;
  return told;
}

std::string name_with_kind(const scene::SceneAt& scene, std::uint32_t object) {
  const scene::SceneObject& thing = scene.object(object);
  const std::string word = word_of(thing.kind, object >= scene.scene().objects().size());
  const bool said = thing.name == word || thing.name.rfind(word + " ", 0) == 0;
  return word.empty() || said ? thing.name : word + " " + thing.name;
}

}  // namespace canyon::mission
