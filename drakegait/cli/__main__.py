from drakegait.cli import main

main()
