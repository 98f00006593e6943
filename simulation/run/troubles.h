#pragma once

#include <string>
#include <vector>

namespace weft {

struct Alarm;

/// What is done about a frame that ends in a state that cannot be.
enum class OnTrouble {
    kStop,    ///< the run ends with an error; what is only doubtful is told
    kHalve,   ///< the frame is done again with steps of half the size, and so all that follow
    kReport,  ///< it is told, and the run goes on while there is a state to go on from
    kIgnore,  ///< energies are not looked at: for those who measure single steps
};

/// A frame whose result is to be doubted, or that was done again with smaller steps.
struct Trouble {
    int frame = 0;
    std::string what;
    bool is_explosion = false;  ///< else it is only to be doubted
};

/// What a run tells of its frames.
class Troubles {
public:
    /// In whole sentences, and however many there are: for what is told once.
    void tell_once(int frame, std::string what);
    /// What was seen, and what becomes of it; not after the first ten.
    void tell(int frame, const Alarm& alarm, const std::string& what);

    const std::vector<Trouble>& list() const { return list_; }

private:
    std::vector<Trouble> list_;
};

}  // namespace weft
