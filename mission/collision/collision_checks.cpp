#include "canyon/mission/collision/collision.h"

namespace canyon::mission {
namespace {

constexpr ModelRow<MakeCollisionCheck> kCollisionChecks[] = {
    {"lines", make_line_check, "lines through the body at two heights, every 0.1 m of the way"},
    {"box", make_box_check, "the whole body against every surface, at every step"},
};

}  // namespace

ModelTable<MakeCollisionCheck> collision_checks() {
  return kCollisionChecks;
}

}  // namespace canyon::mission
