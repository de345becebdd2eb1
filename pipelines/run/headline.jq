# SPDX-License-Identifier: GPL-3.0-or-later
# What a crackstats.json comes down to, in a line:
#
#     jq -rf pipelines/run/headline.jq --arg draws 'draws of the throat radii' CRACKSTATS.json
#
# A program in place of crackstats may have left out all but the counts.
def few: if . < 10 then . * 10 | round / 10 else round end;
def word(one; many): if . == 1 then "1 \(one)" else "\(.) \(many)" end;

(.runs // 1) as $runs
| (.mean.cracks // .cracks) as $mean
| .confidence_interval.cracks.total as $interval
| (if $runs > 1 then "" else "one run: " end)
+ "\($mean.total | few) of \(.bonds | few) bonds broke"
+ (if $runs == 1 then "" else
    [.each[].cracks.total] as $each
    | " (\((.parameters.confidence // 0.95) * 100) % interval of the mean "
    + "\([$interval[0], 0] | max | few) to \($interval[1] | few), "
    + "\($runs) \($draws): \($each | min) to \($each | max))" end)
+ ", \($mean.normal | few) in tension, \($mean.shear | few) in shear"
+ (.mean.unsettled as $u
    | if $u == null then ""
      elif $u.loads == 0 then "; every load came to rest"
      else "; grains still moved at the end of " + ($u.loads | few | word("load"; "loads"))
        + (if $runs > 1 then " a run" else "" end) + ", under which "
        + ($u.cracks | few | word("bond"; "bonds")) + " broke"
        + (if $u.cracks == 0 then ""
           else ". That count may change once grains come to rest: run again with dem-replay.engine=explicit and "
             + "twice the dem-replay.cycles and most_cycles, and compare" end) end)
