#include "server.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>

#include "console.h"
#include "exit_status.h"
#include "hextwist/base/fence.h"
#include "hextwist/base/text.h"
#include "hextwist/io/io.h"
#include "hextwist/session/view/page.h"
#include "live_session.h"

// Behind Eigen: the system headers that it brings make a macro of a name that Eigen uses.
// clang-format off
#include <httplib.h>
// clang-format on

namespace hextwist::app {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;

constexpr std::size_t most_body = 256 * 1024, most_sessions = 8, most_command = 100000, most_line = 4000,
                      most_patience = 15;
// A tab that was closed may be opened again, unless there are too many. Tabs that are there ask at least every 15 s,
// those behind others once a minute.
constexpr std::chrono::seconds idle_time = std::chrono::hours(2), left_time = 90s;
constexpr int n_threads_of_server = 4 * most_sessions;

std::string random_text() {
  std::random_device device;
  std::string result;
  for (int i = 0; i < 8; ++i) {
    std::array<char, 9> part;
    std::snprintf(part.data(), part.size(), "%08x", static_cast<unsigned>(device()));
    result += part.data();
  }
  return result;
}

/// Takes as long whatever is different.
bool same_secret(const std::string& a, const std::string& b) {
  unsigned different = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    different |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return different == 0;
}

void refuse(httplib::Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(Json{{"error", why}}.dump(-1, ' ', false, Json::error_handler_t::replace), "application/json");
}

/// As it is: the library would spend seconds on compressing what goes to a browser on the same machine.
void send(httplib::Response& response, std::string text, const char* type) {
  if (text.empty()) return response.set_content("", type);  // there is nothing to provide
  const auto sent = std::make_shared<const std::string>(std::move(text));
  response.set_content_provider(sent->size(), type,
                                [sent](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                  return sink.write(sent->data() + offset, length);
                                });
}

class Server {
 public:
  explicit Server(const Options& options) : options_(options), token_(random_text()) {}

  int run() {
    page_text();
    http_.new_task_queue = [] { return new httplib::ThreadPool(n_threads_of_server); };
    http_.set_payload_max_length(most_body);
    http_.set_read_timeout(10);
    http_.set_write_timeout(60);
    http_.set_tcp_nodelay(true);
    http_.set_keep_alive_timeout(1);  // so long the end waits for connections that are open
    // A port that was just left can be had again, but no other program may listen there too (SO_REUSEPORT).
    http_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    routes();
    const int port = options_.port ? (http_.bind_to_port(options_.address, options_.port) ? options_.port : -1)
                                   : http_.bind_to_any_port(options_.address);
    if (port < 0)
      throw Error(options_.address + (options_.port ? ":" + std::to_string(options_.port) : "") +
                  " cannot be listened on: it is taken, or is not an address of this machine");
    const bool is_ip6 = options_.address.find(':') != std::string::npos;
    constexpr int usual_port = 80;  // which browsers leave out
    for (const std::string& name : {is_ip6 ? "[" + options_.address + "]" : options_.address, std::string("localhost"),
                                    std::string("127.0.0.1")}) {
      hosts_.push_back(name + ":" + std::to_string(port));
      if (port == usual_port) hosts_.push_back(name);
    }
    std::jthread listener([this] { http_.listen_after_bind(); });
    while (!http_.is_running()) std::this_thread::sleep_for(1ms);  // before that, it could not be stopped
    std::printf("http://%s/?token=%s\nOpen it in a browser on this machine; Ctrl-C ends.\n", hosts_.front().c_str(),
                token_.c_str());
    if (options_.address != "127.0.0.1" && options_.address != "localhost" && options_.address != "::1")
      std::printf("note: everybody who reaches %s and knows the token may run commands here\n",
                  options_.address.c_str());
    std::fflush(stdout);
    while (!take_interrupt() && !ending_signal()) {
      std::this_thread::sleep_for(100ms);
      end_sessions_unseen_for(idle_time);
    }
    {
      const std::lock_guard lock(mutex_);
      for (const auto& [id, session] : sessions_) session->end();
    }
    http_.stop();
    return done;
  }

 private:
  const Options& options_;
  const std::string token_;
  httplib::Server http_;
  std::vector<std::string> hosts_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<LiveSession>> sessions_;

  /// Why a request is refused, "" if it is not.
  std::string refusal(const httplib::Request& request) const {
    const std::string host = request.get_header_value("Host");
    if (std::ranges::find(hosts_, host) == hosts_.end()) return "this is not the address that was printed";
    const std::string origin = request.get_header_value("Origin");
    if (!origin.empty() && origin != "http://" + host) return "requests come from the page itself alone";
    const std::string site = request.get_header_value("Sec-Fetch-Site");
    if (site == "cross-site" || site == "same-site") return "requests come from the page itself alone";
    std::string token = request.get_header_value("X-Hextwist-Token");
    if (token.empty() && request.path == "/") token = request.get_param_value("token");
    if (!same_secret(token, token_)) return "the token is wrong: open the address that was printed";
    return "";
  }

  std::size_t n_sessions() {
    const std::lock_guard lock(mutex_);
    return sessions_.size();
  }

  /// is_full: those of tabs that were closed, too.
  void end_sessions_unseen_for(std::chrono::seconds time, bool is_full = false) {
    std::vector<std::shared_ptr<LiveSession>> ended;  // outlives the lock: ending one may take a moment
    const std::lock_guard lock(mutex_);
    std::erase_if(sessions_, [&](const auto& each) {
      const bool is_unseen = std::chrono::steady_clock::now() - each.second->last_seen() >= time;
      if (!is_unseen && !(is_full && each.second->was_left())) return false;
      ended.push_back(each.second);
      return true;
    });
  }

  std::shared_ptr<LiveSession> session(const std::string& id) {
    const std::lock_guard lock(mutex_);
    const auto found = sessions_.find(id);
    return found == sessions_.end() ? nullptr : found->second;
  }

  std::shared_ptr<LiveSession> fresh_session() {
    const std::filesystem::path stem = options_.mesh.empty() ? options_.cad.stem() : options_.mesh.stem();
    return std::make_shared<LiveSession>(
        stem.empty() ? "hextwist" : stem.string(),
        [this](Session& session) {
          if (options_.threads > 0) session.run("set threads " + std::to_string(options_.threads));
          if (!options_.cad.empty()) session.import_cad(options_.cad);
          if (!options_.mesh.empty()) session.import_mesh(options_.mesh);
          for (const Step& step : options_.steps) step.is_file ? session.playback(step.text) : session.run(step.text);
        },
        options_.most_seconds);
  }

  void open_session(const httplib::Request& request, httplib::Response& response) {
    const Json body = Json::parse(request.body, nullptr, false);
    if (!body.is_object()) return refuse(response, 400, "this is not a JSON object");
    std::string id = body.contains("id") && body["id"].is_string() ? body["id"].get<std::string>() : "";
    const std::shared_ptr<LiveSession> before = id.empty() ? nullptr : session(id);
    const bool is_known = before && !before->has_quit();
    if (is_known) before->come_back();
    if (!is_known) {
      if (n_sessions() >= most_sessions) end_sessions_unseen_for(left_time, true);
      const std::lock_guard lock(mutex_);
      if (sessions_.size() >= most_sessions)
        return refuse(response, 429, "there are " + std::to_string(most_sessions) + " sessions already: close a tab");
      id = random_text();
      sessions_[id] = fresh_session();
    }
    response.set_content(Json{{"id", id}, {"known", is_known}}.dump(), "application/json");
  }

  /// A POST for one session; f(session, body).
  template <class F>
  httplib::Server::Handler posted(F f) {
    return [this, f](const httplib::Request& request, httplib::Response& response) {
      const Json body = Json::parse(request.body, nullptr, false);
      if (!body.is_object() || !body.contains("id") || !body["id"].is_string())
        return refuse(response, 400, "this is not a JSON object with the id of a session");
      const auto live = session(body["id"].get<std::string>());
      if (!live) return refuse(response, 404, "there is no such session");
      f(*live, body, response);
    };
  }

  void routes() {
    http_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      for (const auto& [name, value] : {std::pair{"X-Content-Type-Options", "nosniff"},
                                        {"Referrer-Policy", "no-referrer"},
                                        {"Cache-Control", "no-store"},
                                        {"Cross-Origin-Resource-Policy", "same-origin"},
                                        {"X-Frame-Options", "DENY"},
                                        {"Content-Security-Policy",
                                         "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
                                         "img-src data:; connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; "
                                         "form-action 'none'"}})
        response.set_header(name, value);
      const std::string why = refusal(request);
      if (!why.empty())
        refuse(response, 403, why);
      else if (request.has_header("Transfer-Encoding"))
        refuse(response, 411, "the length of a request must be said");  // the library limits no other ones
      else
        return httplib::Server::HandlerResponse::Unhandled;
      // What follows the head was not read: it must not be taken for another request.
      response.set_header("Connection", "close");
      return httplib::Server::HandlerResponse::Handled;
    });
    http_.set_error_handler([](const httplib::Request&, httplib::Response& response) {
      if (!response.body.empty()) return;
      refuse(response, response.status,
             response.status == 413 ? "the request is larger than " + std::to_string(most_body) + " bytes"
                                    : "there is nothing at this address");
    });
    http_.set_exception_handler([](const httplib::Request&, httplib::Response& response, std::exception_ptr problem) {
      try {
        std::rethrow_exception(problem);
      } catch (const std::exception& error) {
        refuse(response, 500, error.what());
      } catch (...) {
        refuse(response, 500, "an error of an unknown kind");
      }
    });
    http_.Get("/", [](const httplib::Request&, httplib::Response& response) {
      send(response, std::string(page_text()), "text/html; charset=utf-8");
    });
    http_.Post("/session", [this](const auto& request, auto& response) { open_session(request, response); });
    http_.Post("/run", posted([](LiveSession& live, const Json& body, httplib::Response& response) {
                 if (!body.contains("text") || !body["text"].is_string())
                   return refuse(response, 400, "there is no text to run");
                 const auto text = body["text"].get<std::string>();
                 if (text.size() > most_command)
                   return refuse(response, 413,
                                 "a command has at most " + std::to_string(most_command) + " characters");
                 if (text.find_first_not_of(" \t\r\n") == std::string::npos)
                   return refuse(response, 400, "there is no text to run");
                 if (!live.run(text)) return refuse(response, 409, "a command is running");
                 response.set_content("{}", "application/json");
               }));
    http_.Post("/cancel", posted([](LiveSession& live, const Json&, httplib::Response& response) {
                 live.cancel();
                 response.set_content("{}", "application/json");
               }));
    http_.Post("/leave", posted([](LiveSession& live, const Json&, httplib::Response& response) {
                 live.leave();
                 response.set_content("{}", "application/json");
               }));
    http_.Post("/complete", posted([](LiveSession& live, const Json& body, httplib::Response& response) {
                 if (!body.contains("line") || !body["line"].is_string() ||
                     body["line"].get_ref<const std::string&>().size() > most_line)
                   return refuse(response, 400, "there is no line to complete");
                 const auto words = live.completions(body["line"].get<std::string>());
                 if (!words) return refuse(response, 409, "a command is running");
                 response.set_content(Json{{"words", *words}}.dump(-1, ' ', false, Json::error_handler_t::replace),
                                      "application/json");
               }));
    http_.Get("/events", [this](const httplib::Request& request, httplib::Response& response) {
      const auto live = session(request.get_param_value("id"));
      if (!live) return refuse(response, 404, "there is no such session");
      const auto patience = std::chrono::seconds(std::min<std::size_t>(number(request, "wait"), most_patience));
      send(response, live->events(number(request, "since"), patience), "application/json");
    });
    http_.Get("/block", [this](const httplib::Request& request, httplib::Response& response) {
      const auto live = session(request.get_param_value("id"));
      if (!live) return refuse(response, 404, "there is no such session");
      auto sent = live->block(request.get_param_value("name"), number(request, "have"));
      if (!sent) return refuse(response, 409, "a command is running");
      if (sent->is_empty) {
        response.status = 204;
        return;
      }
      if (sent->bytes.empty()) return refuse(response, 404, "there is no such part of the scene");
      response.set_header("X-Hextwist-Number", std::to_string(sent->number));
      response.set_header("X-Hextwist-Difference", sent->is_difference ? "1" : "0");
      send(response, std::move(sent->bytes), "application/octet-stream");
    });
    http_.Get("/file", [this](const httplib::Request& request, httplib::Response& response) {
      const auto live = session(request.get_param_value("id"));
      if (!live) return refuse(response, 404, "there is no such session");
      send_file(*live, request.get_param_value("name"), response);
    });
  }

  /// Zero for what is not a number.
  static std::size_t number(const httplib::Request& request, const char* name) {
    const std::string text = request.get_param_value(name);
    if (text.empty() || text.size() > 15 || text.find_first_not_of("0123456789") != std::string::npos) return 0;
    return std::stoull(text);
  }

  /// Files that the session wrote, and nothing else.
  static void send_file(LiveSession& live, const std::string& name, httplib::Response& response) {
    std::error_code ignored;
    if (!live.has_written(name) || !is_below(std::filesystem::current_path(), name) ||
        !std::filesystem::is_regular_file(name, ignored))
      return refuse(response, 404, "this session has written no such file");
    std::ifstream stream(name, std::ios::binary);
    std::string content{std::istreambuf_iterator<char>(stream), {}};
    response.set_header("Content-Disposition", "attachment");
    send(response, std::move(content), "application/octet-stream");
  }
};

}  // namespace

int serve(const Options& options) {
  return Server(options).run();
}

}  // namespace hextwist::app
