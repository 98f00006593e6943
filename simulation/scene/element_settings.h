#pragma once

#include <any>
#include <map>
#include <typeindex>

namespace weft {

/// What a scene says of element families, each by a plain struct of its own (scene/elements/).
class ElementSettings {
public:
    template <class Settings>
    void set(const Settings& settings) {
        settings_[typeid(Settings)] = settings;
    }
    /// Null: nothing was said.
    template <class Settings>
    const Settings* find() const {
        const auto found = settings_.find(typeid(Settings));
        return found == settings_.end() ? nullptr : std::any_cast<Settings>(&found->second);
    }

private:
    std::map<std::type_index, std::any> settings_;
};

}  // namespace weft
