#include "hextwist/sizing/techniques/technique.h"

#include "hextwist/sizing/techniques/techniques_internal.h"

namespace hextwist {

std::unique_ptr<Technique> make_technique(Approach approach, State& state) {
  switch (approach) {
    case Approach::uniform:
      return uniform_technique(state);
    case Approach::trisect:
      return trisect_technique(state);
    case Approach::eight:
      return eight_technique(state);
    case Approach::parallel:
    case Approach::combination:
      return enclose_technique(state, approach);
    case Approach::thickness:
      return thickness_technique(state);
    case Approach::layers:
      return layers_technique(state);
    case Approach::sheets:
      return sheets_technique(state);
    default:
      return size_technique(state, approach);
  }
}

}  // namespace hextwist
