#include "driver/unproved_ranges.h"

#include "ir/passes/param_reads.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::driver {

static bool is_of_a_field(Code code) {
    return code == Code::LipschitzUnbounded || code == Code::FieldJump ||
           code == Code::FieldSingular || code == Code::NeedsRegion;
}

std::vector<Span> unproved_ranges(const ir::Scene &refused, const Diagnostics &errors,
                                  const std::vector<ir::ShapeId> &asked) {
    for (const Diagnostic &d : errors.items())
        if (d.severity == Severity::Error && !is_of_a_field(d.code)) return {};
    const auto failed = [&](ir::ShapeId id) {
        return id.index < refused.facts.size() &&
               !std::isfinite(refused.facts[id.index].lipschitz_sup);
    };
    ir::ParamReads reads(refused);
    // the lowest: what stands on them fails too
    for (std::size_t i = 0; i < refused.facts.size(); ++i) {
        const ir::ShapeId id{i};
        if (failed(id) && std::ranges::none_of(refused.shapes[id].children, failed)) reads.form(id);
    }
    ir::ParamReads answered(refused);
    for (const ir::ShapeId id : asked) answered.form(id);
    std::vector<Span> params;
    for (std::size_t i = 0; i < refused.params.size(); ++i) {
        if (!refused.params[i].has_range || !reads.used(i)) continue;
        if (answered.used(i)) return {};
        params.push_back(refused.params[i].origin);
    }
    return params;
}

void warn_of_ranges(const ir::Scene &refused, const Diagnostics &errors,
                    const std::vector<Span> &params, Diagnostics &out) {
    std::string names;
    for (const ir::Param &param : refused.params)
        if (std::ranges::find(params, param.origin) != params.end())
            names += fmt::format("{}`{}`", names.empty() ? "" : ", ", param.name);
    const bool one = params.size() == 1;
    for (Diagnostic d : errors.items()) {
        if (d.severity != Severity::Error) continue;
        d.notes.insert(d.notes.begin(),
                       {"another value builds the scene anew, and is proved then; a shader holds "
                        "the present one",
                        fmt::format("for all of the {}: {}", one ? "range" : "ranges", d.message)});
        d.code = Code::RangeUnproved, d.severity = code_severity(d.code);
        d.message =
            fmt::format("this is proved at the present {} of {}, not for all of {}",
                        one ? "value" : "values", names, one ? "its range" : "their ranges");
        out.add(std::move(d));
    }
}

} // namespace fathom::driver
