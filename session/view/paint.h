// From a scene to a picture.
#pragma once

#include "hextwist/session/view/picture.h"
#include "hextwist/session/view/scene.h"

namespace hextwist {

/// What the page shows of a scene at first. Of hexes (of volumes, blocks, sheets) what is seen from outside; faces
/// alone; of edges and nodes the whole mesh, from which they stand out. Throws Error for a colour that the scene does
/// not have.
Picture paint(const SceneSource& source, const SceneStart& start);

}  // namespace hextwist
