# A rover learns to drive to the ball, in an empty folder: pip install 'aionode[bag,gateway,lerobot]'
set -e

python -m aionode.examples.rover &
rover=$!
trap 'kill $rover' EXIT

python -m aionode.examples.rover.learn record
aionode learn export --lerobot ball --max-rate-error 0.2 --max-dropped 0.2 demonstrations
python -m aionode.examples.rover.learn train
python -m aionode.examples.rover.learn drive
