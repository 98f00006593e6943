#include "apps/weft/process/answer.h"

#include "runtime/error.h"

namespace weft {

namespace {

// An answer's first byte: what happened.
constexpr char kDone = '+';
constexpr char kUserError = 'u';
constexpr char kRunError = '!';

}  // namespace

std::string answer_of(const std::function<std::string()>& work) {
    try {
        return kDone + work();
    } catch (const UserError& error) {
        return kUserError + std::string(error.what());
    } catch (const std::exception& error) {
        return kRunError + std::string(error.what());
    }
}

bool is_failure(const std::string& answer) { return answer.at(0) != kDone; }

std::string result_of(const std::string& answer, const std::string& what) {
    const std::string text = answer.substr(1);
    if (answer[0] == kUserError) throw UserError(text);
    if (answer[0] == kRunError) throw RunError(what + ": " + text);
    return text;
}

}  // namespace weft
