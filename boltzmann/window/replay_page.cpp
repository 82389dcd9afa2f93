// Draws and encodes frames as for a browser, and embeds them in the page as JSON and base64.
#include <boltzmann/core/error.hpp>
#include <boltzmann/window/page.hpp>
#include <boltzmann/window/replay_page.hpp>
#include <boltzmann/window/stored_replay.hpp>
#include <boltzmann/window/wire.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

namespace boltzmann {
namespace {

using nlohmann::json;

constexpr std::size_t max_views = 8;          // as for a browser
constexpr std::size_t all = ~std::size_t{0};  // particles
constexpr double table_share = 0.25;          // of the page, at most
constexpr double most_message = 500;          // bytes
constexpr std::size_t many_particles = 10'000, few_particles = 1'000, few_frames = 25;

constexpr char const* why_not = "this is a recording: the run itself is not here";

std::string base64(std::vector<WebPart> const& parts) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  std::size_t bytes = 0;
  for (auto const& part : parts) bytes += part.bytes;
  text.reserve((bytes + 2) / 3 * 4);
  std::uint32_t three = 0;
  int count = 0;
  auto const put = [&](int letters) {
    for (int k = 0; k < letters; ++k) text.push_back(digits[three >> (18 - 6 * k) & 63U]);
    three = 0;
    count = 0;
  };
  for (auto const& part : parts)
    for (auto const* byte = static_cast<unsigned char const*>(part.data);
         byte != static_cast<unsigned char const*>(part.data) + part.bytes; ++byte) {
      three |= std::uint32_t{*byte} << (16 - 8 * count);
      if (++count == 3) put(4);
    }
  if (count > 0) {
    put(count + 1);
    text.resize((text.size() + 3) / 4 * 4, '=');
  }
  return text;
}

/// JSON that is safe in a <script>, without "<".
std::string script_json(json const& value) {
  std::string const text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (char const c : text)
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  return safe;
}

std::string escaped(std::string_view text) {
  std::string safe;
  for (char const c : text) safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return safe;
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  auto const at = text.find(what);
  if (at == text.npos) throw Error("page.html has no '" + std::string(what) + "'");
  return text.replace(at, what.size(), by);
}

/// The page with the embedded recording. A browser accepts only its script, by its digest, and loads nothing else.
std::string page_with(std::string const& recording, std::string const& title) {
  std::string html(page_html());
  constexpr std::string_view name = "<meta name=\"boltzmann-script\" content=\"";
  auto const at = html.find(name);
  if (at == html.npos) throw Error("page.html has no digest of its script");
  std::string const digest = html.substr(at + name.size(), html.find('"', at + name.size()) - at - name.size());
  std::string const policy = "default-src 'none'; script-src '" + digest +
                             "'; style-src 'unsafe-inline'; img-src data: blob:; media-src blob:; base-uri 'none'; "
                             "form-action 'none'";
  html = replaced(std::move(html), "<head>",
                  "<head>\n<meta http-equiv=\"Content-Security-Policy\" content=\"" + policy + "\">");
  html = replaced(std::move(html), "<title>Boltzmann</title>", "<title>" + escaped(title) + " · Boltzmann</title>");
  auto const end = html.rfind("</body>");
  return html.insert(end, "<script type=\"application/json\" id=\"recording\">" + recording + "</script>\n  ");
}

/// A selection of `count` indices, evenly spaced, including the first and the last.
std::vector<std::size_t> evenly(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  std::size_t const n = std::min(count, most);
  for (std::size_t k = 0; k < n; ++k) chosen.push_back(n == 1 ? count - 1 : (k * (count - 1) + (n - 1) / 2) / (n - 1));
  return chosen;
}

/// Every n-th row, so that the table has at most this size in base64.
ShownTable thinned(ShownTable const& table, double most_bytes, std::size_t& stride) {
  double const bytes = static_cast<double>(table.values.size() * sizeof(double)) * 4 / 3;
  stride = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(bytes / most_bytes)));
  ShownTable fewer;
  fewer.number = table.number;
  fewer.columns = table.columns;
  for (std::size_t r = 0; r < table.rows(); r += stride)
    fewer.values.insert(fewer.values.end(), table.values.begin() + static_cast<std::ptrdiff_t>(r * table.columns),
                        table.values.begin() + static_cast<std::ptrdiff_t>((r + 1) * table.columns));
  return fewer;
}

/// A frame as sent to a browser.
struct Encoded {
  std::string text;
  /// The size in the list of frames, with quotation marks and comma.
  double bytes() const { return static_cast<double>(text.size() + 3); }
  // for each view with particles: their number, and bytes per particle
  std::vector<std::size_t> particles, particle_bytes;
  std::uint32_t stride = 1;  // one of this number of particles is included
};

/// The size of a frame in the page.
struct FrameSize {
  double fixed = 0;                                // bytes without its particles
  std::vector<std::size_t> particles, each_bytes;  // per view

  explicit FrameSize(Encoded const& frame)
      : fixed(frame.bytes()), particles(frame.particles), each_bytes(frame.particle_bytes) {
    for (std::size_t v = 0; v < particles.size(); ++v)
      fixed -= static_cast<double>(particles[v] * each_bytes[v]) * 4 / 3;
  }
  std::size_t most_particles() const {
    return particles.empty() ? 0 : *std::max_element(particles.begin(), particles.end());
  }
  /// The size with at most this number of particles per view. Selected particles also have a number each.
  double bytes(std::size_t most) const {
    double sum = fixed;
    for (std::size_t v = 0; v < particles.size(); ++v) {
      std::size_t const each = each_bytes[v] + (particles[v] > most ? sizeof(std::uint32_t) : 0);
      sum += static_cast<double>(std::min(particles[v], most) * each) * 4 / 3;
    }
    return sum;
  }
  /// The number of particles per view that fit into this size.
  std::size_t particles_in(double room) const {
    if (bytes(all) <= room) return all;
    std::size_t low = 0, high = most_particles();
    while (low + 1 < high) (bytes((low + high) / 2) <= room ? low : high) = (low + high) / 2;
    return low;
  }
};

struct Plan {
  std::size_t frames, most;  // most: particles per view
};

/// Reduces the number of particles while there are many, then frames; then both further. Nothing if even that does not
/// fit.
std::optional<Plan> plan_for(FrameSize const& size, std::size_t frames, double room) {
  std::size_t const particles = size.most_particles();
  for (auto const& [least_particles, least_frames] :
       {std::pair{many_particles, few_frames}, std::pair{few_particles, std::size_t{1}}}) {
    std::size_t const least = std::min(least_particles, particles), enough = std::min(least_frames, frames);
    std::size_t const most = size.particles_in(room / static_cast<double>(frames));
    if (most >= least) return Plan{frames, most};
    auto const fit = static_cast<std::size_t>(std::max(0.0, room / size.bytes(least)));
    if (fit >= enough) return Plan{std::min(fit, frames), least < particles ? least : all};
    frames = enough;
  }
  return {};
}

class PageWriter {
 public:
  PageWriter(Replay& replay, ReplayPageOptions const& options)
      : replay_(replay), options_(options), hello_(replay.hello()), stored_(replay.status()["frames"]) {
    if (!(options.megabytes > 0) || options.megabytes > 1e6)
      throw Error(fmt::format("a page has more than 0 megabytes and up to 1000000, not {}", options.megabytes));
    if (options.frames == 0) throw Error("a page has one frame or more, not 0");
    if (options.views.size() > max_views)
      throw Error(fmt::format("a page has {} views at most, not {}", max_views, options.views.size()));
    choose_views();
  }

  ReplayPage write() {
    double const limit = options_.megabytes * 1e6;
    std::size_t row_stride = 1;
    if (replay_.table()) {
      ShownTable const table = thinned(*replay_.table(), table_share * limit, row_stride);
      BinaryMessage message;
      json const head{{"table", table_json(table, 0, message)}};
      table_ = base64(message.finish(head).parts);
    }
    double const around = static_cast<double>(page({}, "").size()) + most_message;
    double const room = limit - around;
    std::size_t const wanted = std::min(options_.frames, stored_);
    FrameSize const size(encode(stored_ / 2, all));
    for (double target = room;;) {
      auto const plan = plan_for(size, wanted, target);
      if (!plan)
        throw Error(
            fmt::format("a page of {} MB has no room for a frame of this run: {:.2g} MB beside {:.2g} MB of page and "
                        "table; allow more, or show fewer views",
                        options_.megabytes, size.bytes(few_particles) / 1e6, around / 1e6));
      auto const chosen = evenly(stored_, plan->frames);
      std::vector<Encoded> frames;
      double total = 0;
      for (std::size_t const frame : chosen) {
        frames.push_back(encode(frame, plan->most));
        total += frames.back().bytes();
        if (total > room) break;
      }
      if (total <= room) return finish(frames, row_stride);
      // Later frames are larger than the measured one.
      double const all_of_them = total * static_cast<double>(chosen.size()) / static_cast<double>(frames.size());
      target *= std::min(0.9, room / all_of_them);
    }
  }

 private:
  void choose_views() {
    json kept = json::array(), tables = json::array();
    for (auto const& shown : hello_["diagnoses"])
      if (shown["drawing"] == "table") tables.push_back(shown);
    auto const find = [&](std::string const& name) {
      for (auto const& shown : hello_["diagnoses"])
        if (shown["name"] == name) return shown;
      return json();
    };
    auto names = options_.views;
    for (std::size_t k = 0; names.empty() && k < hello_["diagnoses"].size(); ++k)
      if (hello_["diagnoses"][k]["drawing"] != "table") names.push_back(hello_["diagnoses"][k]["name"]);
    for (auto const& name : names) {
      json const shown = find(name);
      if (!shown.is_null() && shown["drawing"] == "table") continue;
      json const view{{"id", views_.size() + 1}, {"diagnosis", name}};
      replay_.draw(view);  // throws its errors before anything is written
      views_.push_back(view);
      kept.push_back(shown);
    }
    for (auto& table : tables) kept.push_back(std::move(table));
    hello_["diagnoses"] = std::move(kept);
    hello_["drawings"] = json::object();  // nothing of a picture can be changed
    hello_["recording"] = true;
    hello_["folder"] = "";  // a path of another machine for most readers
    for (char const* what : {"step_size", "checkpoint", "quit"}) hello_["can"][what] = why_not;
  }

  Encoded encode(std::size_t frame, std::size_t most) {
    replay_.perform({{"do", "seek"}, {"frame", frame}});
    Encoded result;
    BinaryMessage message;
    json head = replay_.status();
    head["type"] = "update";
    head["viewers"] = 1;
    head["selected"] = nullptr;
    json& views = head["views"] = json::array();
    for (json view : views_) {
      if (most != all) view["most"] = most;
      try {
        auto const canvas = replay_.draw(view);
        std::size_t particles = 0, bytes = 0;
        for (auto const& cloud : canvas->clouds()) {
          particles += cloud.count();
          bytes += 4 * (cloud.position.size() + cloud.value.size() + cloud.diameter.size() + cloud.number.size());
          result.stride = std::max(result.stride, cloud.stride);
        }
        if (particles > 0) {
          result.particles.push_back(particles);
          result.particle_bytes.push_back((bytes + particles - 1) / particles);
        }
        views.push_back({{"id", view["id"]}, {"canvas", canvas_json(canvas, message)}});
      } catch (Error const& error) {  // of this frame only, for example no particles for a histogram
        views.push_back({{"id", view["id"]}, {"error", error.what()}});
      }
    }
    result.text = base64(message.finish(head).parts);
    return result;
  }

  ReplayPage finish(std::vector<Encoded> const& frames, std::size_t row_stride) {
    ReplayPage page{"", frames.size(), stored_, ""};
    std::uint32_t stride = 1;
    for (auto const& frame : frames) stride = std::max(stride, frame.stride);
    std::vector<std::string> parts;
    if (page.frames < stored_) parts.push_back(fmt::format("{} of {} frames", page.frames, stored_));
    if (stride > 1) parts.push_back(fmt::format("one of {} particles", stride));
    if (row_stride > 1) parts.push_back(fmt::format("one of {} rows of the table", row_stride));
    if (!parts.empty()) {
      bool const for_size = page.frames < std::min(options_.frames, stored_) || stride > 1 || row_stride > 1;
      page.message = "a recording with " + join(parts);
      if (for_size) page.message += fmt::format(", so that it is no larger than {} MB", options_.megabytes);
    }
    page.html = this->page(frames, page.message);
    return page;
  }

  std::string page(std::vector<Encoded> const& frames, std::string const& message) const {
    json recording{{"hello", hello_}, {"views", views_}, {"message", message}, {"table", table_}};
    json& updates = recording["updates"] = json::array();
    for (auto const& frame : frames) updates.push_back(frame.text);
    std::string const title = hello_["title"], name = hello_["name"];
    return page_with(script_json(recording), title.empty() ? name : title);
  }

  Replay& replay_;
  ReplayPageOptions const& options_;
  json hello_, views_ = json::array();
  std::string table_;  // empty: there is none
  std::size_t stored_;
};

}  // namespace

ReplayPage replay_page(Replay& replay, ReplayPageOptions const& options) { return PageWriter(replay, options).write(); }

ReplayPage replay_page(std::string const& folder, ReplayPageOptions const& options) {
  StoredReplay stored(folder);
  ReplayPageOptions chosen = options;
  for (auto const& name : stored.own_views())
    if (options.views.empty() && chosen.views.size() < max_views) try {
        stored.replay().draw({{"diagnosis", name}});
        chosen.views.push_back(name);
      } catch (Error const&) {
        // views that need the history of a run, such as a wave spectrum, are not possible from frames
      }
  return replay_page(stored.replay(), chosen);
}

}  // namespace boltzmann
