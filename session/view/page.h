// The viewer: one file of HTML with a scene inside. Its source is the folder page; it is bundled when Node.js is there.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hextwist/session/view/scene.h"

namespace hextwist {

/// The page without a scene; throws Error where this program was built without it.
std::string_view page_text();
/// Does this program have the page?
bool has_page();

struct Page {
  std::string text;
  std::vector<std::string> left_out;  ///< what made it too large: names of channels, or "inside"
};
/// The page with all of the scene inside, at most `most_bytes` large (but for the skin, which is always there); what
/// the mesh was like before (null: nothing) is shown beside. Throws Error where there is no page.
Page page(const SceneSource& source, const SceneStart& start, const SceneSource* before = nullptr,
          std::size_t most_bytes = 60000000);

}  // namespace hextwist
