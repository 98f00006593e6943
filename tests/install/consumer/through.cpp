#include <cstdio>
#include <string>

std::string state_after_halving(const char* devices);

int main(int, char** arguments) {
    std::printf("state %s\n", state_after_halving(arguments[1]).c_str());
    return 0;
}
