// Pictures by OpenGL (fathom/gl.h), of a library that is built without it: nothing opens.
#include "api/impl.h"

#include <fathom/gl.h>

namespace fathom::v1 {

struct GlPainter::Impl {};

GlPainter::GlPainter() = default;
GlPainter::GlPainter(GlPainter &&) noexcept = default;
GlPainter &GlPainter::operator=(GlPainter &&) noexcept = default;
GlPainter::~GlPainter() = default;

namespace {
constexpr const char *why = "this Fathom was built without OpenGL (-DFATHOM_GL=ON builds with it)";
}

std::string GlPainter::open() { return why; }
bool GlPainter::is_open() const { return false; }
std::string GlPainter::describe() const { return ""; }
bool GlPainter::is_software() const { return false; }
int GlPainter::largest_side() const { return 0; }
std::string GlPainter::text(const Scene &) const { return ""; }
std::vector<Diagnostic> GlPainter::use(const Scene &, const GlOptions &) {
    return {sentence("usage", why)};
}
bool GlPainter::is_cached() const { return false; }
std::string GlPainter::exact_because() const { return ""; }
double GlPainter::driver_seconds() const { return 0; }
Picture GlPainter::draw(const PictureOptions &) {
    Picture none;
    none.remark = why;
    return none;
}
bool GlPainter::draw_for_nothing(const PictureOptions &) { return false; }
GlLists GlPainter::lists() const { return {}; }
void GlPainter::remake_lists() {}

struct GlShader::Impl {};

GlShader::GlShader() = default;
GlShader::GlShader(GlShader &&) noexcept = default;
GlShader &GlShader::operator=(GlShader &&) noexcept = default;
GlShader::~GlShader() = default;

std::string GlShader::load(const Shader &) { return why; }
void GlShader::set(const std::vector<ShaderInput> &) {}
bool GlShader::draw(int, int) { return false; }
double GlShader::cached_share() const { return 0; }

} // namespace fathom::v1
