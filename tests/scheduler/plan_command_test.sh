# `weft plan`: the published numbers, and one clear message with exit code 2 for every bad graph.
set -u
data=$WEFT_ROOT/tests/scheduler/data
failures=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# expect_makespan GRAPH ALGORITHM MAKESPAN
expect_makespan() {
    "$WEFT" plan "$data/$1.json" --algorithm "$2" --json >out.json || fail "$1 $2: exit code $?"
    grep -q "^  \"makespan\": $3.0,$" out.json || fail "$1 $2: $(grep makespan out.json), not $3"
}

# expect_error PART-OF-MESSAGE GRAPH-TEXT [OPTION...]
expect_error() {
    local message=$1
    printf '%s' "$2" >graph.json
    shift 2
    "$WEFT" plan graph.json "$@" >out.txt 2>err.txt
    local code=$?
    [ $code -eq 2 ] || fail "$message: exit code $code"
    [ "$(wc -l <err.txt)" -eq 1 ] || fail "$message: not one line: $(cat err.txt)"
    [ -s out.txt ] && fail "$message: output on stdout"
    grep -qF -- "$message" err.txt || fail "expected '$message', got: $(cat err.txt)"
}

expect_makespan topcuoglu-2002 heft 80
expect_makespan topcuoglu-2002 cpop 86
expect_makespan topcuoglu-2002 peft 85
expect_makespan topcuoglu-2002 lookahead 76
expect_makespan topcuoglu-2002 hps 76
expect_makespan topcuoglu-2002 optimal 73
expect_makespan arabnejad-2014 heft 133
expect_makespan arabnejad-2014 peft 122
expect_makespan arabnejad-2014 optimal 113
expect_makespan insertion heft 22

task='{"name": "a", "cost": [1, 2]}'
graph() { echo "{\"processors\": [\"p\", \"q\"], \"tasks\": [$1], \"edges\": [$2]}"; }

# Communication is latency + size / bandwidth; a lone second processor is worth 1 + (3 + 8 / 4) + 1.
cat >links.json <<'JSON'
{"processors": ["p", "q"], "latency": 3, "bandwidth": 4,
 "tasks": [{"name": "a", "cost": [1, null]}, {"name": "b", "cost": [null, 1]}],
 "edges": [["a", "b", 8]]}
JSON
"$WEFT" plan links.json --json | grep -q '"makespan": 7.0,' || fail "latency and bandwidth"
sed -i 's/"latency": 3/"latency": [[0, 5], [3, 0]]/' links.json
"$WEFT" plan links.json --json | grep -q '"makespan": 9.0,' || fail "latency per pair"

# Figure 3 of the paper: 8 tasks of 2 on the CPU, 1 on the GPU, 2.5 to change; merged by four.
row='{"name": "b0", "cost": [2, 1], "kind": 0, "iteration": 0}'
edges='["start", "b0", 0]'
for i in 1 2 3 4 5 6 7; do
    row="$row, {\"name\": \"b$i\", \"cost\": [2, 1], \"kind\": 0, \"iteration\": $((i / 4))}"
    edges="$edges, [\"b$((i - 1))\", \"b$i\", 0]"
done
cat >figure3.json <<JSON
{"processors": ["cpu", "gpu"], "latency": 2.5,
 "tasks": [{"name": "start", "cost": [0, null]}, $row], "edges": [$edges]}
JSON
"$WEFT" plan figure3.json --algorithm heft --json | grep -q '"makespan": 16.0,' || fail "figure 3"
"$WEFT" plan figure3.json --algorithm heft --merge 6 --json >out.json || fail "--merge: code $?"
grep -q '"makespan": 10.5,' out.json || fail "--merge: $(cat out.json)"
"$WEFT" plan figure3.json --compare --open-iterations 1 >out.txt || fail "--open-iterations"
grep -q '^heft-gs ' out.txt || fail "heft-gs: $(cat out.txt)"
"$WEFT" plan figure3.json --open-iterations 0 >out.txt 2>&1 && fail "--open-iterations 0"

# Three tasks of 1 on two processors, without any edge; a barrier after each iteration.
free='{"name": "a", "cost": [1, 1], "iteration": 0}, {"name": "b", "cost": [1, 1], "iteration": 1},
      {"name": "c", "cost": [1, 1], "iteration": 2}'
echo "{\"processors\": [\"p\", \"q\"], \"tasks\": [$free]}" >free.json
for limit in 1:3.0 2:2.0 3:2.0; do
    "$WEFT" plan free.json --algorithm optimal --open-iterations "${limit%:*}" --json >out.json
    grep -q "\"makespan\": ${limit#*:}," out.json || fail "open $limit: $(cat out.json)"
done

"$WEFT" plan "$data/topcuoglu-2002.json" --compare >compare.txt || fail "--compare"
grep -Eq '^optimal +73 +0.0 %.*optimal$' compare.txt || fail "table: $(cat compare.txt)"
"$WEFT" plan "$data/topcuoglu-2002.json" | grep -q '^p3 |n1=' || fail "Gantt chart"

expect_error "graph.json: tasks[0].iteration: expected a whole number >= 0, not -1" \
    "$(graph '{"name": "a", "cost": [1, 2], "iteration": -1}' '')"
back='{"name": "a", "cost": [1, 2], "iteration": 1}, {"name": "b", "cost": [1, 2], "iteration": 0}'
expect_error 'graph.json: a task depends on a task of a later iteration' \
    "$(graph "$back" '["a", "b", 0]')" --algorithm heft-gs
expect_error 'graph.json: the tasks form a cycle: a -> b -> a' \
    "$(graph "$back" '["a", "b", 0]')" --open-iterations 1
expect_error 'graph.json: tasks: the graph is empty' "$(graph '' '')"
expect_error 'graph.json: edges: the tasks form a cycle: a -> b -> a' \
    "$(graph "$task, {\"name\": \"b\", \"cost\": [1, 1]}" '["a", "b", 1], ["b", "a", 1]')"
expect_error "graph.json: edges[0][1]: unknown task 'c'" "$(graph "$task" '["a", "c", 1]')"
expect_error "graph.json: tasks[1].name: duplicate task 'a'" "$(graph "$task, $task" '')"
expect_error 'graph.json: tasks[0].cost[1]: expected a finite number >= 0' \
    "$(graph '{"name": "a", "cost": [1, -2]}' '')"
expect_error 'graph.json: tasks[0].cost[0]: expected a finite number >= 0' \
    "$(graph '{"name": "a", "cost": ["1", 2]}' '')"
expect_error 'graph.json: tasks[0].cost[0]: must be at most 1e+100, not 1e+308' \
    "$(graph '{"name": "a", "cost": [1e308, 2]}' '')"
expect_error 'graph.json: not JSON: number overflow' "$(graph '{"name": "a", "cost": [1e999, 2]}' '')"
expect_error 'graph.json:1:' "$(graph '{"name": "a", "cost": [NaN, 2]}' '')"
expect_error "graph.json: tasks[0].cost: no processor can run task 'a'" \
    "$(graph '{"name": "a", "cost": [null, null]}' '')"
expect_error "graph.json: tasks[0].cost: task 'a' has 1 costs for 2 processors" \
    "$(graph '{"name": "a", "cost": [1]}' '')"
expect_error 'graph.json: edges[0]: expected ["from", "to", data]' "$(graph "$task" '["a", "a"]')"
expect_error 'graph.json: edges[0][2]: expected a finite number >= 0, not -1' \
    "$(graph "$task" '["a", "a", -1]')"
expect_error 'graph.json: processors: is missing' '{"tasks": []}'
expect_error 'graph.json: processors: at least one' '{"processors": [], "tasks": []}'
expect_error "graph.json: processors[1]: duplicate processor 'p'" \
    '{"processors": ["p", "p"], "tasks": []}'
expect_error "graph.json: latencies: unknown key; did you mean 'latency'?" \
    '{"processors": ["p"], "tasks": [], "latencies": 1}'
expect_error 'graph.json: bandwidth: expected a number > 0, not 0' \
    '{"processors": ["p", "q"], "tasks": [], "bandwidth": 0}'
expect_error 'graph.json: latency: expected a number or 2 rows of 2 numbers >= 0' \
    '{"processors": ["p", "q"], "tasks": [], "latency": [1]}'
expect_error 'graph.json: expected one object' '[1, 2]'
expect_error 'graph.json:2:1: not JSON' '{"processors":
}'
expect_error 'graph.json:1:1: not JSON' ''
expect_error "'hefty' is unknown; did you mean 'heft'?" "$(graph "$task" '')" --algorithm hefty

"$WEFT" plan missing.json 2>err.txt
[ $? -eq 2 ] || fail "missing file: exit code"
grep -q 'missing.json: No such file' err.txt || fail "missing file: $(cat err.txt)"
"$WEFT" plan . 2>err.txt
[ $? -eq 2 ] || fail "folder: exit code"

[ $failures -eq 0 ] && echo "all as expected"
exit $((failures > 0))
