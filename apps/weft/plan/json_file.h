#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace weft {

/// A JSON file that a user wrote. What does not fit throws UserError with the file and the line and
/// column, or the field, what is wrong with which value, and what would be right.
class JsonFile {
public:
    using Json = nlohmann::json;

    /// Reads and parses it.
    explicit JsonFile(std::string path);

    const Json& root() const { return root_; }

    [[noreturn]] void fail(const std::string& what) const;
    [[noreturn]] void fail(const std::string& field, const std::string& what) const;

    /// Other keys are left to whoever wrote them; but not those that look like a slip of ours.
    void check_keys(const Json& object, const std::vector<std::string>& known,
                    const std::string& prefix) const;
    const Json& member(const Json& object, const std::string& key, const std::string& prefix) const;
    /// A finite number >= 0.
    double number(const Json& value, const std::string& field, const std::string& expected) const;
    /// Text that is not empty.
    std::string name(const Json& value, const std::string& field) const;
    const Json& array(const Json& value, const std::string& field,
                      const std::string& expected) const;
    const Json& object(const Json& value, const std::string& field,
                       const std::string& expected) const;
    /// A list of different names, at least one; `what` is one of them: "processor".
    std::vector<std::string> names(const Json& value, const std::string& field,
                                   const std::string& what) const;

    /// The value for messages, cut where it is long.
    static std::string shown(const Json& value);

private:
    std::string path_;
    Json root_;
};

/// The members `latency` and `bandwidth` of a file: each one number for all pairs of processors, or
/// a row per processor that data come from with a number per processor that they go to.
struct LinkValues {
    std::vector<double> latency, bandwidth;  ///< [from * count + to]; the diagonal does not count
};
/// Where they are left out, latency is 0 and bandwidth is `usual_bandwidth`; null stands for an
/// infinite bandwidth.
LinkValues read_links(const JsonFile& file, std::size_t count, double usual_bandwidth);

}  // namespace weft
