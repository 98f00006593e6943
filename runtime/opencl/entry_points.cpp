#include "runtime/opencl/entry_points.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>
#include <stdexcept>

#include "kernels/sources.h"
#include "runtime/error.h"
#include "runtime/split.h"

namespace weft {

namespace {

using kernels::Parameter;

bool is_in_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '#';
}

/// With WEFT_KERNEL(name, parameters) written out as functions. OpenCL C has no macros of any
/// number of arguments: NVIDIA's compiler refuses what others take for an extension.
std::string with_kernels_as_functions(std::string_view text) {
    std::string out;
    while (true) {
        const auto begin = std::min(text.find("WEFT_KERNEL("), text.find("WEFT_NARROW_KERNEL("));
        out += text.substr(0, begin);
        if (begin == std::string_view::npos) return out;
        const std::string_view head = text.substr(begin, text.find('(', begin) + 1 - begin);
        text.remove_prefix(begin + head.size());
        const auto end = std::ranges::find_if_not(text, is_in_name);
        const std::string_view name(text.begin(), end);
        const bool is_definition = !name.empty() && end != text.end() && *end == ',';
        if (is_definition)
            out.append("WEFT_INLINE void ").append(name).append("(item i");
        else
            out.append(head).append(name);  // in a comment
        text.remove_prefix(name.size());
    }
}

/// Puts headers one after the other, each once, each behind those that it includes. #line makes the
/// compiler's messages name the real file.
class HeaderText {
public:
    void add(const kernels::SourceFile& file) {
        if (seen_.emplace(file.path).second) append(file);
    }
    std::string text() const { return out_.str(); }

private:
    void add_included(std::string_view name, const kernels::SourceFile& by) {
        // Headers of the C++ targets are not embedded, and nothing here needs them.
        if (name.starts_with("kernels/platform/") || name == "kernels/sources.h") {
            if (const auto* file = kernels::find_included(name)) add(*file);
            return;
        }
        const kernels::SourceFile* file = kernels::find_included(name);
        if (file == nullptr) {
            throw Misuse("'" + std::string(name) + "', which " + std::string(by.path) +
                         " includes, has no text for OpenCL: give it to weft_add_kernels()");
        }
        add(*file);
    }

    void append(const kernels::SourceFile& file) {
        std::istringstream lines{with_kernels_as_functions(file.text)};
        std::string line;
        out_ << "#line 1 \"" << file.path << "\"\n";
        for (int number = 1; std::getline(lines, line); ++number) {
            if (const std::string_view name = included_by(line); !name.empty()) {
                add_included(name, file);
                out_ << "#line " << number + 1 << " \"" << file.path << "\"\n";
            } else {
                out_ << line << '\n';
            }
        }
    }

    /// What a line includes, of what is embedded: "...", and <weft/...>.
    static std::string_view included_by(std::string_view line) {
        for (const std::string_view begin : {"#include \"", "#include <weft/"}) {
            if (!line.starts_with(begin)) continue;
            const std::size_t name = std::string_view("#include \"").size();
            return line.substr(name, line.find_first_of("\">", name) - name);
        }
        return {};
    }

    std::set<std::string, std::less<>> seen_;
    std::ostringstream out_;
};

/// As it is written: a parameter's declaration without its name, which stands last.
std::string written_type(const kernels::KernelInfo& kernel, std::size_t parameter) {
    const std::string text = split(kernel.parameter_text, ',').at(parameter);
    const std::size_t last = text.find_last_not_of(" \n\t");
    const std::size_t name = text.find_last_of(" *\n\t", last);
    return text.substr(0, name + 1) + ' ';
}

std::string type_name(const kernels::KernelInfo& kernel, std::size_t parameter) {
    switch (kernel.parameters[parameter]) {
        case Parameter::kReadFloat:
            return "__global const float* ";
        case Parameter::kReadInt:
            return "__global const int* ";
        case Parameter::kReadFloat4:
            return "__global const float4* ";
        case Parameter::kWriteFloat:
            return "__global float* ";
        case Parameter::kWriteInt:
            return "__global int* ";
        case Parameter::kWriteFloat4:
            return "__global float4* ";
        case Parameter::kFloat:
            return "float ";
        case Parameter::kInt:
            return "int ";
        case Parameter::kReadOther:
        case Parameter::kWriteOther:
            return written_type(kernel, parameter);
    }
    throw std::logic_error("unknown parameter type");
}

std::string parameter_name(std::size_t launch, std::size_t parameter) {
    return "p" + std::to_string(launch) + "_" + std::to_string(parameter);
}

/// The entry point's parameters for one launch: all but what is filled in at run time, which is
/// common to all.
void declare_parameters(std::ostream& out, const Launch& launch, std::size_t number) {
    for (std::size_t k = 0; k < launch.arguments.size(); ++k) {
        if (launch.arguments[k].run_value != RunValue::kNone) continue;
        out << type_name(*launch.kernel, k) << parameter_name(number, k) << ", ";
    }
}

std::string argument_text(const Launch& launch, std::size_t number, std::size_t k) {
    switch (launch.arguments[k].run_value) {
        case RunValue::kOfInstance:
            return "instance";
        case RunValue::kOfIteration:
            return "iteration";
        case RunValue::kNone:
            return parameter_name(number, k);
    }
    throw std::logic_error("unknown run value");
}

void call_kernel(std::ostream& out, const Launch& launch, std::size_t number) {
    out << launch.kernel->name << "(i";
    for (std::size_t k = 0; k < launch.arguments.size(); ++k) {
        out << ", " << argument_text(launch, number, k);
    }
    out << ");";
}

std::string segment_parameters(const Launch& launch, std::size_t number) {
    const std::string l = std::to_string(number);
    const std::string gate = launch.gate == nullptr ? "" : "__global const int* gate" + l + ", ";
    return "__global const int* segments" + l + ", int first" + l + ", int colours" + l + ", " +
           gate;
}

/// A condition, and that the strip has something to do, where that is asked.
std::string and_is_open(std::string condition, const Launch& launch, std::size_t number) {
    if (launch.gate == nullptr) return condition;
    if (!condition.empty()) condition += " && ";
    return condition + "gate" + std::to_string(number) + "[strip] != 0";
}

/// Where items of a strip's colour end: where they begin, if a condition does not hold.
std::string end_where(const std::string& condition) {
    return condition.empty() ? "segment[1]" : condition + " ? segment[1] : begin";
}

/// Points to the first item of the strip's colour; behind it stands where that colour ends.
std::string segment_of(std::size_t launch) {
    const std::string l = std::to_string(launch);
    return "    __global const int* segment = segments" + l + " + first" + l +
           " + strip * colours" + l + " + colour;\n";
}

/// One colour of the strip. The mask tells the compiler that the last lanes are fewer than
/// WEFT_LANES, so that it drops the path of whole lanes there: PoCL then builds vertex block
/// descent over tetrahedra in 10 s instead of 24 s.
void items_of_one(std::ostream& out, const Launch& launch, std::size_t l) {
    out << "        int end = " << end_where(and_is_open("", launch, l)) << ";\n"
        << "        for (; begin + WEFT_LANES <= end; begin += WEFT_LANES) {\n"
        << "            item i = {begin, WEFT_LANES};\n            ";
    call_kernel(out, launch, l);
    out << "\n        }\n"
        << "        if (begin < end) {\n"
        << "            item i = {begin, (end - begin) & (WEFT_LANES - 1)};\n            ";
    call_kernel(out, launch, l);
    out << "\n        }\n";
}

/// The same by the work-items of a group, which all see what this colour has written before they go
/// on. (There may be no colours.)
void items_of_group(std::ostream& out, const Launch& launch, std::size_t l) {
    const std::string is_colour = "colour < colours" + std::to_string(l);
    out << "        int end = " << end_where(and_is_open(is_colour, launch, l)) << ";\n"
        << "        begin += (int)get_local_id(0) * WEFT_LANES;\n"
        << "        for (; begin < end; begin += (int)get_local_size(0) * WEFT_LANES) {\n"
        << "            item i = {begin, min(end - begin, WEFT_LANES)};\n            ";
    call_kernel(out, launch, l);
    out << "\n        }\n"
        << "        barrier(CLK_GLOBAL_MEM_FENCE);\n";
}

/// Launches [first, end) in turns, colour by colour of the first's segments. A group goes through
/// its loop at least once: where a barrier might be passed over, PoCL compiles all that follows it
/// twice, and twice again for the next.
void loop_over_colours(std::ostream& out, const TaskBody& body, std::size_t first, std::size_t end,
                       EntryStyle style) {
    const bool is_group = style == EntryStyle::kPerGroup;
    const std::string colours = "colours" + std::to_string(first);
    out << "    for (int colour = 0;" << (is_group ? ";" : " colour < " + colours + "; ++colour")
        << ") {\n";
    for (std::size_t l = first; l < end; ++l) {
        out << "    {\n    " << segment_of(l) << "        int begin = segment[0];\n";
        (is_group ? items_of_group : items_of_one)(out, body.launches[l], l);
        out << "    }\n";
    }
    if (is_group) out << "    if (++colour >= " << colours << ") break;\n";
    out << "    }\n";
}

/// What follows the name of a body's entry point.
std::string whole_body_entry(const TaskBody& body, EntryStyle style) {
    std::ostringstream out;
    out << "(";
    for (std::size_t l = 0; l < body.launches.size(); ++l) {
        declare_parameters(out, body.launches[l], l);
        out << segment_parameters(body.launches[l], l);
    }
    out << "int first_strip, int instance, int iteration) {\n"
        << "    int strip = first_strip + (int)get_group_id(0);\n";
    const auto turns = static_cast<std::size_t>(body.taking_turns);
    if (turns > 0) loop_over_colours(out, body, 0, turns, style);
    for (std::size_t l = turns; l < body.launches.size(); ++l) {
        loop_over_colours(out, body, l, l + 1, style);
    }
    out << "}\n\n";
    return out.str();
}

std::string group_attribute(int size) {
    return "__attribute__((reqd_work_group_size(" + std::to_string(size) + ", 1, 1)))\n";
}

/// What follows the name of a launch's entry point. Work-items (item, strip); in strips with fewer
/// items than the largest, some have nothing to do.
std::string per_colour_entry(const Launch& launch) {
    std::ostringstream out;
    out << "(";
    declare_parameters(out, launch, 0);
    out << segment_parameters(launch, 0)
        << "int colour, int first_strip, int instance, int iteration) {\n"
        << "    int strip = first_strip + (int)get_global_id(1);\n"
        << segment_of(0) << "    int first = segment[0] + (int)get_global_id(0) * WEFT_LANES;\n"
        << "    if (!(" << and_is_open("first < segment[1]", launch, 0) << ")) return;\n"
        << "    item i = {first, min(segment[1] - first, WEFT_LANES)};\n    ";
    call_kernel(out, launch, 0);
    out << "\n}\n\n";
    return out.str();
}

/// [bytes] of a body's entry point, with the longest pointers.
std::size_t parameter_bytes(const TaskBody& body) {
    constexpr std::size_t kPointer = 8, kNumber = 4;
    std::size_t bytes = 3 * kNumber;
    for (const Launch& launch : body.launches) {
        bytes += kPointer + 2 * kNumber;  // segments
        if (launch.gate != nullptr) bytes += kPointer;
        for (const Argument& argument : launch.arguments) {
            if (argument.run_value != RunValue::kNone) continue;
            bytes += argument.buffer != nullptr ? kPointer : kNumber;
        }
    }
    return bytes;
}

EntryStyle style_of(const TaskBody& body, const EntryOptions& options) {
    const bool fits =
        options.style != EntryStyle::kPerGroup || parameter_bytes(body) <= options.most_parameters;
    return fits ? options.style : EntryStyle::kPerColour;
}

std::string file_of(const kernels::KernelInfo& kernel) {
    if (kernels::find_source(kernel.file) == nullptr) {
        throw Misuse("kernel '" + std::string(kernel.space) + std::string(kernel.name) +
                     "' has no text for OpenCL: give its header to weft_add_kernels()");
    }
    return std::string(kernel.file);
}

/// Adds an entry point. It is named after its first kernel, for those who look at it in other
/// tools.
void add(EntryPoints& points, std::string_view kernel, const std::string& attributes,
         const std::string& parameters_and_body) {
    const std::string number = std::to_string(points.names.size());
    const std::string name = "run_" + std::string(kernel) + '_' + number;
    points.names.push_back(name);
    points.definitions += "__kernel " + attributes + "void " + name + parameters_and_body;
}

}  // namespace

EntryPoints entry_points(const TaskBody& body, const EntryOptions& options) {
    EntryPoints points{style_of(body, options), {}, "", {}};
    for (const Launch& launch : body.launches) points.files.push_back(file_of(*launch.kernel));
    if (points.style == EntryStyle::kPerColour) {
        for (const Launch& launch : body.launches) {
            add(points, launch.kernel->name, "", per_colour_entry(launch));
        }
        return points;
    }
    const int size = points.style == EntryStyle::kPerStrip ? 1 : options.group_size;
    const std::string_view first =
        body.launches.empty() ? "nothing" : body.launches.front().kernel->name;
    add(points, first, group_attribute(size), whole_body_entry(body, points.style));
    return points;
}

std::string program_text(const EntryPoints& points) {
    HeaderText headers;
    for (const std::string& file : points.files) headers.add(*kernels::find_source(file));
    return headers.text() + "#line 1 \"entry points\"\n" + points.definitions;
}

}  // namespace weft
