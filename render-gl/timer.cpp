#include "render-gl/timer.h"

#include <epoxy/gl.h>

namespace fathom::gl {

Timer::~Timer() {
    if (queries_[0]) glDeleteQueries(static_cast<GLsizei>(maximum), queries_.data());
}

bool Timer::begin() {
    if (!queries_[0]) glGenQueries(static_cast<GLsizei>(maximum), queries_.data());
    if (asked_ - answered_ == maximum) return false;
    glBeginQuery(GL_TIME_ELAPSED, queries_[asked_ % maximum]);
    open_ = true;
    return true;
}

void Timer::end() {
    if (!open_) return;
    glEndQuery(GL_TIME_ELAPSED);
    glFlush(); // an end that stays in the queue is never answered
    open_ = false;
    ++asked_;
}

std::optional<double> Timer::poll() {
    if (answered_ == asked_) return std::nullopt;
    const GLuint query = queries_[answered_ % maximum];
    GLint there = 0;
    glGetQueryObjectiv(query, GL_QUERY_RESULT_AVAILABLE, &there);
    if (!there) return std::nullopt;
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
    ++answered_;
    return static_cast<double>(nanoseconds) * 1e-6;
}

} // namespace fathom::gl
