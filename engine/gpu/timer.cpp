#include "engine/gpu/timer.hpp"

#include <array>
#include <cassert>
#include <chrono>

namespace petrichor {
namespace {

constexpr int kFramesInFlight = 6;  // drivers queue up to three frames; the rest is slack

struct Span {
  std::string name;
  std::size_t begin = 0, end = 0;  // query indices, hardware only
  double milliseconds = 0;
  std::chrono::steady_clock::time_point started;
};

struct FrameRecord {
  std::vector<Span> spans;
  std::vector<GLuint> queries;  // reused from lap to lap
  std::size_t queries_used = 0;
  bool pending = false;  // recorded, not handed out
};

}  // namespace

struct FrameTimer::Impl {
  std::array<FrameRecord, kFramesInFlight> frames;
  int next = 0;                   // the record begin_frame() takes
  FrameRecord* now = nullptr;     // null: this frame is not timed
  std::vector<std::size_t> open;  // indices into now->spans

  std::size_t stamp() {
    if (now->queries_used == now->queries.size()) {
      GLuint query = 0;
      glCreateQueries(GL_TIMESTAMP, 1, &query);
      now->queries.push_back(query);
    }
    glQueryCounter(now->queries[now->queries_used], GL_TIMESTAMP);
    return now->queries_used++;
  }
};

FrameTimer::FrameTimer(bool software_gl) : software_(software_gl), impl_(new Impl) {}

FrameTimer::~FrameTimer() {
  for (FrameRecord& frame : impl_->frames) {
    if (!frame.queries.empty()) glDeleteQueries(static_cast<GLsizei>(frame.queries.size()), frame.queries.data());
  }
  delete impl_;
}

void FrameTimer::begin_frame(bool profile) {
  Impl& timer = *impl_;
  assert(!timer.now && "begin_frame without end_frame");
  if (software_ && !profile) return;
  FrameRecord& frame = timer.frames[timer.next];
  // Nobody collected for a whole lap: on hardware leave this frame untimed rather than stall on old queries.
  if (frame.pending && !software_) return;
  frame.spans.clear();
  frame.queries_used = 0;
  frame.pending = false;
  timer.now = &frame;
}

void FrameTimer::begin(std::string_view name) {
  Impl& timer = *impl_;
  if (!timer.now) return;
  Span span{std::string(name)};
  if (software_) {
    glFinish();
    span.started = std::chrono::steady_clock::now();
  } else {
    span.begin = timer.stamp();
  }
  timer.open.push_back(timer.now->spans.size());
  timer.now->spans.push_back(std::move(span));
}

void FrameTimer::end() {
  Impl& timer = *impl_;
  if (!timer.now) return;
  assert(!timer.open.empty() && "end without begin");
  Span& span = timer.now->spans[timer.open.back()];
  timer.open.pop_back();
  if (software_) {
    glFinish();
    span.milliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - span.started).count();
  } else {
    span.end = timer.stamp();
  }
}

void FrameTimer::end_frame() {
  Impl& timer = *impl_;
  if (!timer.now) return;
  assert(timer.open.empty() && "a span is still open");
  timer.now->pending = !timer.now->spans.empty();
  timer.now = nullptr;
  timer.open.clear();
  timer.next = (timer.next + 1) % kFramesInFlight;
}

std::vector<Timing> FrameTimer::collect() {
  Impl& timer = *impl_;
  // Walk from the oldest; queries finish in order, so the newest finished frame is the last before the first gap.
  FrameRecord* newest = nullptr;
  for (int i = 0; i < kFramesInFlight; ++i) {
    FrameRecord& frame = timer.frames[(timer.next + i) % kFramesInFlight];
    if (!frame.pending || &frame == timer.now) continue;
    if (!software_) {
      GLint available = 0;
      glGetQueryObjectiv(frame.queries[frame.queries_used - 1], GL_QUERY_RESULT_AVAILABLE, &available);
      if (!available) break;
    }
    frame.pending = false;
    newest = &frame;
  }
  std::vector<Timing> timings;
  if (!newest) return timings;
  for (const Span& span : newest->spans) {
    double milliseconds = span.milliseconds;
    if (!software_) {
      GLuint64 begin = 0, end = 0;
      glGetQueryObjectui64v(newest->queries[span.begin], GL_QUERY_RESULT, &begin);
      glGetQueryObjectui64v(newest->queries[span.end], GL_QUERY_RESULT, &end);
      milliseconds = static_cast<double>(end - begin) * 1e-6;
    }
    timings.push_back({span.name, milliseconds});
  }
  return timings;
}

}  // namespace petrichor
