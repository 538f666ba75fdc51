#include "render-gl/passes.h"

#include "render-gl/framebuffer.h"
#include "render-gl/pruning.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace fathom::gl {

namespace {

// What a text by passes says of a ray, at location 2.
constexpr float goes_on = 0.9f, eye_passed = 0.125f, eye_undecided = 0.25f, light_undecided = 0.5f,
                within = 0.05f;
constexpr GLenum rays_place = GL_COLOR_ATTACHMENT2;

constexpr GLenum kept_place(std::size_t i) { return GL_COLOR_ATTACHMENT3 + static_cast<GLenum>(i); }

GLuint texture(GLint format, GLenum layout, int width, int height) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, layout, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    return name;
}

void attach(GLenum place, GLuint name) {
    if (name) glFramebufferTexture2D(GL_FRAMEBUFFER, place, GL_TEXTURE_2D, name, 0);
}

void draw_into(bool picks, std::size_t kept) {
    GLenum places[7] = {GL_COLOR_ATTACHMENT0,
                        static_cast<GLenum>(picks ? GL_COLOR_ATTACHMENT1 : GL_NONE), rays_place};
    for (std::size_t i = 0; i < kept; ++i) places[3 + i] = kept_place(i);
    glDrawBuffers(static_cast<GLsizei>(3 + kept), places);
}

} // namespace

Passes::~Passes() {
    release();
    if (query_) glDeleteQueries(1, &query_);
}

void Passes::release() {
    for (GLuint *framebuffer : {&first_, &marks_, &turned_[0], &turned_[1]}) {
        if (*framebuffer) glDeleteFramebuffers(1, framebuffer);
        *framebuffer = 0;
    }
    for (auto &textures : kept_)
        for (GLuint &name : textures) {
            if (name) glDeleteTextures(1, &name);
            name = 0;
        }
    if (rays_) glDeleteTextures(1, &rays_);
    if (depth_) glDeleteRenderbuffers(1, &depth_);
    rays_ = depth_ = 0;
    drawn_ = {};
}

bool Passes::use(const Drawn &drawn) {
    if (drawn == drawn_ && rays_) return true;
    release();
    while (glGetError() != GL_NO_ERROR) {
    } // what was wrong before is not ours to report
    if (!query_) glGenQueries(1, &query_);
    drawn_ = drawn;
    rays_ = texture(GL_R8, GL_RED, drawn.width, drawn.height);
    glGenRenderbuffers(1, &depth_);
    glBindRenderbuffer(GL_RENDERBUFFER, depth_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, drawn.width, drawn.height);
    glGenFramebuffers(1, &first_);
    glBindFramebuffer(GL_FRAMEBUFFER, first_);
    attach(GL_COLOR_ATTACHMENT0, drawn.color);
    attach(GL_COLOR_ATTACHMENT1, drawn.picks);
    attach(rays_place, rays_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
    draw_into(drawn.picks != 0, 0);
    bool good = complete();
    glGenFramebuffers(1, &marks_);
    glBindFramebuffer(GL_FRAMEBUFFER, marks_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    good &= complete() && glGetError() == GL_NO_ERROR;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (!good) release();
    return good;
}

bool Passes::make_kept() {
    if (turned_[0]) return true;
    while (glGetError() != GL_NO_ERROR) {
    }
    bool good = true;
    for (std::size_t k = 0; k < 2; ++k) {
        glGenFramebuffers(1, &turned_[k]);
        glBindFramebuffer(GL_FRAMEBUFFER, turned_[k]);
        attach(GL_COLOR_ATTACHMENT0, drawn_.color);
        attach(GL_COLOR_ATTACHMENT1, drawn_.picks);
        attach(rays_place, rays_);
        for (std::size_t i = 0; i < kept_[k].size(); ++i) {
            kept_[k][i] = texture(GL_RGBA32F, GL_RGBA, drawn_.width, drawn_.height);
            attach(kept_place(i), kept_[k][i]);
        }
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
        draw_into(drawn_.picks != 0, kept_[k].size());
        good &= complete();
    }
    good &= glGetError() == GL_NO_ERROR;
    if (!good) release();
    return good;
}

void Passes::begin(const Program &program, int bottom, int rows, int turns,
                   std::span<const std::uint8_t> only) {
    mark_ = program.marks();
    bottom_ = bottom;
    rows_ = rows;
    turns_ = turns;
    pass_ = 0;
    left_ = 1; // or more: nobody knows yet
    some_ = !only.empty();
    if (!some_) return;
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, rays_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, bottom, drawn_.width, rows, GL_RED, GL_UNSIGNED_BYTE,
                    only.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    count(goes_on, 2, true);
}

// Every pass is of all views: what it wrote is read by the next one, and never by itself.
bool Passes::draw(const Program &program, const std::function<void(const Pass &pass)> &draw) {
    if (keeps() && !(program.prepare_to_keep() && make_kept())) return false;
    const auto now = static_cast<std::size_t>(pass_ % 2);
    Pass pass;
    pass.keeps = keeps();
    pass.turns = turns_ > 0 ? turns_ : pass.keeps ? program.most_turns() : program.first_turns();
    pass.resumed = pass_ > 1;
    pass.kept = kept_[1 - now];
    glBindFramebuffer(GL_FRAMEBUFFER, keeps() ? turned_[now] : first_);
    for (GLuint i = 2; i < (keeps() ? 7U : 3U); ++i) glDisablei(GL_BLEND, i);
    glDisable(GL_DEPTH_TEST);
    if (pass_ == 0) {
        glEnable(GL_SCISSOR_TEST); // between views nothing is drawn
        glScissor(0, bottom_, drawn_.width, rows_);
        const float none[] = {0, 0, 0, 0}, all = 1;
        glClearBufferfv(GL_COLOR, 2, none);
        glDepthMask(GL_TRUE);
        if (!some_) glClearBufferfv(GL_DEPTH, 0, &all);
    }
    // In every pass: a driver on the processor compiles a text anew for another test.
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS); // the triangle lies at 0.5, a ray that goes on at 1
    glDepthMask(GL_FALSE);
    draw(pass);
    glDisable(GL_DEPTH_TEST);
    ++pass_;
    left_ = count(within, 2, true); // of most pictures there is nothing left to say
    if (left_ == 0) return true;
    left_ = count(goes_on, 2, true);
    if (left_ > 0) return true;
    const auto about = [&](float value) { return count(value - within, value + within, false); };
    const std::uint64_t both = about(eye_undecided + light_undecided),
                        unlit = about(eye_passed + light_undecided);
    undecided_.rays += about(eye_undecided) + both;
    undecided_.shadows += about(light_undecided) + both + unlit;
    undecided_.passed += about(eye_passed) + unlit;
    return true;
}

// The rays of which that is said; marked for the depth test of the next pass.
std::uint64_t Passes::count(float above, float below, bool mark) const {
    glBindFramebuffer(GL_FRAMEBUFFER, marks_);
    glViewport(0, 0, drawn_.width, drawn_.height);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, bottom_, drawn_.width, rows_);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(mark ? GL_TRUE : GL_FALSE);
    glDepthRange(1, 1);
    const float done = 0;
    if (mark) glClearBufferfv(GL_DEPTH, 0, &done);
    glUseProgram(mark_);
    glUniform1i(glGetUniformLocation(mark_, "rays"), 0);
    glUniform2f(glGetUniformLocation(mark_, "between"), above, below);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, rays_);
    glBeginQuery(GL_SAMPLES_PASSED, query_);
    draw_triangle();
    glEndQuery(GL_SAMPLES_PASSED);
    GLuint number = 0;
    glGetQueryObjectuiv(query_, GL_QUERY_RESULT, &number);
    glDepthRange(0, 1);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_SCISSOR_TEST);
    return number;
}

} // namespace fathom::gl
