#include "hextwist/session/view/page.h"

#include <algorithm>
#include <utility>

#include "hextwist/base/parallel.h"
#include "hextwist/base/text.h"

#ifdef HEXTWIST_PAGE
// The bundled page as it is, without a detour through an array of numbers.
asm(".section .rodata\n"
    ".global hextwist_page_begin\n"
    ".hidden hextwist_page_begin\n"
    "hextwist_page_begin:\n"
    ".incbin \"" HEXTWIST_PAGE
    "\"\n"
    ".global hextwist_page_end\n"
    ".hidden hextwist_page_end\n"
    "hextwist_page_end:\n"
    ".byte 0\n"
    ".text\n");
extern "C" const char hextwist_page_begin[], hextwist_page_end[];
#endif

namespace hextwist {
namespace {

constexpr std::string_view data_mark = "<!--scene-->", title_mark = "<title>hextwist</title>";

std::string script(const std::string& id, const std::string& content) {
  return "<script type=\"text/plain\" id=\"" + id + "\">" + content + "</script>\n";
}

/// The blocks of one scene, as far as they fit into `room`, which gets smaller; the skin is there in any case.
std::string scripts(const SceneSource& source, const SceneStart& start, const std::string& prefix, std::size_t& room,
                    std::vector<std::string>& left_out) {
  const std::vector<Channel> all = channels(source);
  std::vector<std::pair<std::string, PackedBlock>> blocks;
  blocks.emplace_back("inside", inside_block(source));
  blocks.emplace_back("cad", cad_block(source));
  blocks.emplace_back("sets", sets_block(source));
  std::vector<std::string> texts(blocks.size() + all.size());
  parallel_each(
      blocks.size(), [&](std::size_t i) { texts[i] = base64(deflated(blocks[i].second)); }, 1);
  const std::size_t n_blocks = blocks.size();
  // One after the other: each has loops on all threads, and none is needed twice.
  for (std::size_t i = 0; i < all.size(); ++i) texts[n_blocks + i] = base64(deflated(channel_block(source, all[i])));
  const auto name = [&](std::size_t i) { return i < n_blocks ? blocks[i].first : all[i - n_blocks].name; };

  std::string result;
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::string id = i < n_blocks ? name(i) : "c" + std::to_string(i - n_blocks);
    if (texts[i].size() > room) {
      missing.push_back(name(i));
      continue;
    }
    room -= texts[i].size();
    result += script(prefix + id, texts[i]);
    texts[i] = {};
  }
  left_out.insert(left_out.end(), missing.begin(), missing.end());
  return script(prefix + "skin", base64(deflated(skin_block(source, scene_meta(source, all, start, missing))))) +
         result;
}

}  // namespace

bool has_page() {
#ifdef HEXTWIST_PAGE
  return true;
#else
  return false;
#endif
}

std::string_view page_text() {
#ifdef HEXTWIST_PAGE
  return {hextwist_page_begin, static_cast<std::size_t>(hextwist_page_end - hextwist_page_begin)};
#else
  throw Error("this program was built without its page, which needs Node.js and npm; pictures (.png) it can draw");
#endif
}

Page page(const SceneSource& source, const SceneStart& start, const SceneSource* before, std::size_t most_bytes) {
  const std::string_view frame = page_text();
  Page result;
  std::size_t room = most_bytes - std::min(most_bytes, frame.size());
  // Nothing is loaded from anywhere: the browser sees to that too.
  constexpr std::string_view alone =
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
      "style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'\">";
  std::string data = scripts(source, start, "", room, result.left_out);
  if (before) data += scripts(*before, {}, "before-", room, result.left_out);
  const std::size_t at = frame.find(data_mark), title = frame.find(title_mark);
  if (at == std::string_view::npos || title == std::string_view::npos || title > at)
    throw Error("the page of this program has no place for a scene");
  result.text.reserve(frame.size() + data.size() + 1000);
  result.text += frame.substr(0, title);
  result.text += "<title>" + markup_text(source.title) + "</title>\n";
  result.text += alone;
  result.text += frame.substr(title + title_mark.size(), at - title - title_mark.size());
  result.text += data;
  result.text += frame.substr(at + data_mark.size());
  return result;
}

}  // namespace hextwist
